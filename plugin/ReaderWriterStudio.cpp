// SPDX-License-Identifier: MIT
#include "PseudoLoader.h"

#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/nodes/studio/Studio.h>
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>

#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

bool isYUp(const osgDB::Options* options)
{
    const std::vector<gltf::OptionWord> words = gltf::splitOptions(options ? options->getOptionString() : "");
    return std::any_of(words.begin(), words.end(),
                       [](const gltf::OptionWord& word) { return word.name == "noRotation"; });
}

/// A studio around the model, which keeps its axes.
osg::ref_ptr<osg::Node> inStudio(osg::Node* model, bool modelIsYUp)
{
    osg::ref_ptr<Studio> studio = new Studio;
    studio->addEventCallback(new RaisedHome);
    if (!modelIsYUp)
    {
        studio->addChild(model);
        return studio;
    }
    const osg::Matrixd toZUp = osg::Matrixd::rotate(osg::Vec3d(0, 1, 0), osg::Vec3d(0, 0, 1));
    osg::ref_ptr<osg::MatrixTransform> upright = new osg::MatrixTransform(toZUp);
    osg::ref_ptr<osg::MatrixTransform> back = new osg::MatrixTransform(osg::Matrixd::inverse(toZUp));
    upright->addChild(model);
    studio->addChild(upright);
    back->addChild(studio);
    return back;
}

} // namespace

/// The pseudo-loader for the studio: `fox.glb.studio` reads `fox.glb` with the plugin of its extension and puts it into
/// a Studio. `fox.glb.20x20.crowd.studio` shows a crowd there.
class ReaderWriterStudio : public PseudoLoader
{
public:
    ReaderWriterStudio()
    {
        supportsExtension("studio", "pseudo-loader: MODEL.studio");
        supportsOption("noRotation", "keep glTF's +Y up; default: +Z up");
    }

    const char* className() const override { return "osgGpuAnimation studio pseudo-loader"; }

protected:
    ReadResult read(const std::string& modelFile, const Options* options) const override
    {
        if (osgDB::getLowerCaseFileExtension(modelFile).empty())
            return ReadResult(gltf::quoted(modelFile) + " is not a model's file, like fox.glb in fox.glb.studio");
        ReadResult model = readModel(modelFile, options, "studio");
        if (!model.validNode()) return model;
        if (!model.getNode()->getBound().valid())
            OSG_WARN << className() << ": " << modelFile << ": nothing to see, so the studio is empty" << std::endl;
        return ReadResult(inStudio(model.getNode(), isYUp(options)).get());
    }
};

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterStudio;
REGISTER_OSGPLUGIN(studio, ReaderWriterStudio)
