// SPDX-License-Identifier: MIT
#include "PseudoLoader.h"

#include "crowd/CrowdGrid.h"

#include <osg/Notify>
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
        const Result<crowd::CrowdOptions> wanted = crowd::parseCrowd(name, given);
        if (!wanted) return ReadResult(wanted.error().message);
        for (const std::string& hint : crowd::optionHints(given))
            OSG_WARN << className() << ": " << hint << std::endl;
        const std::string& modelFile = wanted.value().modelFile;
        osg::ref_ptr<Options> forModel = options ? options->cloneOptions() : new Options;
        forModel->setOptionString(crowd::modelOptions(given));
        ReadResult model = readModel(modelFile, forModel.get(), "crowd");
        if (!model.validNode()) return model;
        const Result<osg::ref_ptr<AnimatedCrowd>> crowd = crowd::makeCrowd(*model.getNode(), wanted.value());
        if (!crowd) return ReadResult(modelFile + ": " + crowd.error().message);
        return ReadResult(crowd.value().get());
    }
};

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterCrowd;
REGISTER_OSGPLUGIN(crowd, ReaderWriterCrowd)
