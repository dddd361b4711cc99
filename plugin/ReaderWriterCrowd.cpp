// SPDX-License-Identifier: MIT
#include "PseudoLoader.h"

#include "crowd/CrowdGrid.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

namespace osgGpuAnimation
{

/// The pseudo-loader for crowds: `fox.glb.40x40.crowd` reads `fox.glb` with the plugin of its extension and shows its
/// animated character 1600 times in 40 columns and 40 rows, each with a clip and a time of its own.
class ReaderWriterCrowd : public PseudoLoader
{
public:
    ReaderWriterCrowd()
    {
        supportsExtension("crowd", "pseudo-loader: MODEL.COLUMNSxROWS.crowd");
        for (const auto& [name, help] : crowd::optionHelp())
            supportsOption(name, help);
    }

    const char* className() const override { return "osgGpuAnimation crowd pseudo-loader"; }

protected:
    ReadResult read(const std::string& name, const Options* options) const override
    {
        const std::string given = options ? options->getOptionString() : std::string();
        Result<crowd::CrowdOptions> parsed = crowd::parseCrowd(name, given);
        if (!parsed) return ReadResult(parsed.error().message);
        crowd::CrowdOptions wanted = std::move(parsed).value();
        wanted.outfits = findOutfits(wanted, options);
        for (const std::string& hint : crowd::optionHints(given))
            OSG_WARN << className() << ": " << hint << std::endl;
        const std::string& modelFile = wanted.modelFile;
        osg::ref_ptr<Options> forModel = options ? options->cloneOptions() : new Options;
        forModel->setOptionString(crowd::modelOptions(given));
        ReadResult model = readModel(modelFile, forModel.get(), "crowd");
        if (!model.validNode()) return model;
        const Result<osg::ref_ptr<AnimatedCrowd>> crowd = crowd::makeCrowd(*model.getNode(), wanted);
        if (!crowd) return ReadResult(modelFile + ": " + crowd.error().message);
        return ReadResult(crowd.value().get());
    }

private:
    /// The path of the outfits file, which may lie beside the model.
    static std::string findOutfits(const crowd::CrowdOptions& wanted, const Options* options)
    {
        if (wanted.outfits.empty() || wanted.outfits == "random") return wanted.outfits;
        const std::string found = osgDB::findDataFile(wanted.outfits, options);
        if (!found.empty()) return found;
        const std::string model = osgDB::findDataFile(wanted.modelFile, options);
        const std::string beside = osgDB::concatPaths(osgDB::getFilePath(model), wanted.outfits);
        return osgDB::fileExists(beside) ? beside : wanted.outfits;
    }
};

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterCrowd;
REGISTER_OSGPLUGIN(crowd, ReaderWriterCrowd)
