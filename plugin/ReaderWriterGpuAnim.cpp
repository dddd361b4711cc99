// SPDX-License-Identifier: MIT
#include "osganimation/SkeletonConversion.h"
#include "PseudoLoader.h"

#include <osgGpuAnimation/nodes/CharacterKeys.h>

#include <osg/Notify>
#include <osgDB/Registry>

namespace osgGpuAnimation
{

namespace
{

/// OSG's reader of COLLADA has the texture of a material in unit 1 unless an option of its own tells otherwise;
/// characters have theirs in unit 0.
osg::ref_ptr<osgDB::Options> withTexturesFromUnit0(const osgDB::Options* options)
{
    osg::ref_ptr<osgDB::Options> changed = options ? options->cloneOptions() : new osgDB::Options;
    if (changed->getOptionString().find("daeUsePredefinedTextureUnits") == std::string::npos)
        changed->setOptionString(changed->getOptionString() + " daeUseSequencedTextureUnits");
    return changed;
}

} // namespace

/// The pseudo-loader for osgAnimation's scenes: `nathan.osg.gpuanim` reads `nathan.osg` with the plugin of its
/// extension and puts AnimatedCharacters in the places of its skeletons; see osganimation::convertOsgAnimation().
class ReaderWriterGpuAnim : public PseudoLoader
{
public:
    ReaderWriterGpuAnim() { supportsExtension("gpuanim", "pseudo-loader: MODEL.gpuanim, of osgAnimation's scenes"); }

    const char* className() const override { return "osgGpuAnimation pseudo-loader of osgAnimation's scenes"; }

protected:
    ReadResult read(const std::string& modelFile, const Options* options) const override
    {
        ReadResult model = readModel(modelFile, withTexturesFromUnit0(options), "character");
        if (!model.validNode()) return model;
        osg::ref_ptr<osg::Node> scene = model.takeNode();
        const osganimation::Conversion converted = osganimation::convertOsgAnimation(*scene);
        for (const std::string& warning : converted.warnings)
            OSG_WARN << modelFile << ": " << warning << std::endl;
        if (converted.characters.empty())
            OSG_WARN << modelFile << ": there is no skeleton of osgAnimation; the scene stays as it is" << std::endl;
        for (const osg::ref_ptr<AnimatedCharacter>& character : converted.characters)
            character->addEventCallback(new CharacterKeys);
        return ReadResult(converted.node.get());
    }
};

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterGpuAnim;
REGISTER_OSGPLUGIN(gpuanim, ReaderWriterGpuAnim)
