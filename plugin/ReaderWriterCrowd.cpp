// SPDX-License-Identifier: MIT
#include "crowd/CrowdGrid.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <new>

namespace osgGpuAnimation
{

/// The pseudo-loader for crowds: `fox.glb.40x40.crowd` reads `fox.glb` with the plugin of its extension and shows its
/// animated character 1600 times in 40 columns and 40 rows, each with a clip and a time of its own.
class ReaderWriterCrowd : public osgDB::ReaderWriter
{
public:
    ReaderWriterCrowd()
    {
        supportsExtension("crowd", "pseudo-loader: MODEL.COLUMNSxROWS.crowd");
        for (const auto& [name, help] : crowd::optionHelp())
            supportsOption(name, help);
    }

    const char* className() const override { return "osgGpuAnimation crowd pseudo-loader"; }

    ReadResult readObject(const std::string& fileName, const Options* options) const override
    {
        return readNode(fileName, options);
    }

    ReadResult readNode(const std::string& fileName, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName))) return ReadResult::FILE_NOT_HANDLED;
        try
        {
            return read(osgDB::getNameLessExtension(fileName), options);
        }
        catch (const std::bad_alloc&)
        {
            return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
        }
    }

private:
    ReadResult read(const std::string& name, const Options* options) const
    {
        const std::string given = options ? options->getOptionString() : std::string();
        const Result<crowd::CrowdOptions> wanted = crowd::parseCrowd(name, given);
        if (!wanted) return ReadResult(wanted.error().message);
        for (const std::string& hint : crowd::optionHints(given))
            OSG_WARN << className() << ": " << hint << std::endl;
        const std::string& modelFile = wanted.value().modelFile;
        osg::ref_ptr<Options> forModel = options ? options->cloneOptions() : new Options;
        forModel->setOptionString(crowd::modelOptions(given));
        ReadResult model = osgDB::Registry::instance()->readNode(modelFile, forModel.get());
        if (!model.validNode())
        {
            if (!model.message().empty()) return ReadResult(modelFile + ": " + model.message());
            return ReadResult("the crowd's model " + modelFile + " cannot be read");
        }
        const Result<osg::ref_ptr<AnimatedCrowd>> crowd = crowd::makeCrowd(*model.getNode(), wanted.value());
        if (!crowd) return ReadResult(modelFile + ": " + crowd.error().message);
        return ReadResult(crowd.value().get());
    }
};

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterCrowd;
REGISTER_OSGPLUGIN(crowd, ReaderWriterCrowd)
