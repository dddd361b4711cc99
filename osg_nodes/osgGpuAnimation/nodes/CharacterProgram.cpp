// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CharacterProgram.h>

#include <osgGpuAnimation/nodes/SurfaceProgram.h>

#include <layout.glsl>
#include <ShaderSources.h>

#include <osg/observer_ptr>
#include <osg/Texture2D>

#include <mutex>
#include <string>

namespace osgGpuAnimation
{

namespace
{

/// GLSL 1.40 has all that skinning needs, and in a compatibility context still the fixed pipeline's names.
osg::Shader* makeShader(osg::Shader::Type type, std::initializer_list<const char*> parts)
{
    std::string source = "#version 140\n";
    for (const char* part : parts)
        source += part;
    return new osg::Shader(type, source);
}

/// What all users share at a time, made by the first. It lives as long as some scene has it: OSG releases the GL
/// objects of what is in scenes when a context is closed, and an object that outlives them would keep stale ones.
template <typename Object>
class Shared
{
public:
    template <typename Make>
    osg::ref_ptr<Object> get(Make make)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        osg::ref_ptr<Object> object;
        if (_object.lock(object)) return object;
        object = make();
        _object = object.get();
        return object;
    }

private:
    std::mutex _mutex;
    osg::observer_ptr<Object> _object;
};

osg::ref_ptr<osg::Program> makeProgram()
{
    osg::ref_ptr<osg::Program> program = new SurfaceProgram;
    program->setName("osgGpuAnimation character");
    return program;
}

/// What it is known by: copies and files have it too, and draw threads need no lock to compare it.
constexpr const char* whiteTextureName = "osgGpuAnimation white";

osg::ref_ptr<osg::Texture2D> makeWhiteTexture()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(osg::Vec4(1, 1, 1, 1), 0, 0);
    osg::ref_ptr<osg::Texture2D> white = new osg::Texture2D(image);
    white->setName(whiteTextureName);
    // OSG's default, GL_CLAMP, mixes in the black border.
    white->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    white->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    return white;
}

osg::ref_ptr<osg::Texture2D> whiteTexture()
{
    static Shared<osg::Texture2D> shared;
    return shared.get(makeWhiteTexture);
}

} // namespace

osg::ref_ptr<osg::Shader> skinShader()
{
    static Shared<osg::Shader> shared;
    return shared.get(
        [] {
            return osg::ref_ptr<osg::Shader>(
                makeShader(osg::Shader::VERTEX, {shaders::layout_glsl, shaders::skin_glsl}));
        });
}

void bindSkinAttributes(osg::Program& program)
{
    program.addBindAttribLocation("poseEntries0", POSE_ENTRIES_0_LOCATION);
    program.addBindAttribLocation("poseWeights0", POSE_WEIGHTS_0_LOCATION);
    program.addBindAttribLocation("poseEntries1", POSE_ENTRIES_1_LOCATION);
    program.addBindAttribLocation("poseWeights1", POSE_WEIGHTS_1_LOCATION);
    program.addBindAttribLocation("posePlacementRow0", POSE_PLACEMENT_ROW_0_LOCATION);
    program.addBindAttribLocation("posePlacementRow1", POSE_PLACEMENT_ROW_1_LOCATION);
    program.addBindAttribLocation("posePlacementRow2", POSE_PLACEMENT_ROW_2_LOCATION);
    program.addBindAttribLocation("posePlacedPose", POSE_PLACED_POSE_LOCATION);
}

osg::ref_ptr<osg::Program> characterProgram()
{
    static Shared<osg::Program> shared;
    return shared.get(makeProgram);
}

void applyCharacterProgram(osg::StateSet& stateSet)
{
    // Casting cameras of osgShadow override programs with none, which would draw the bind pose.
    stateSet.setAttributeAndModes(characterProgram(), osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    stateSet.getOrCreateUniform("baseColorTexture", osg::Uniform::SAMPLER_2D)->set(0);
    if (!stateSet.getUniform("alphaCutoff")) stateSet.addUniform(new osg::Uniform("alphaCutoff", 0.0f));
    if (!stateSet.getUniform("unlit")) stateSet.addUniform(new osg::Uniform("unlit", false));
    if (!stateSet.getTextureAttribute(0, osg::StateAttribute::TEXTURE))
        stateSet.setTextureAttributeAndModes(0, whiteTexture());
}

bool isWhiteTexture(const osg::StateAttribute* texture)
{
    return texture && texture->getName() == whiteTextureName;
}

void applySkinDefines(osg::StateSet& stateSet, int influences, bool hasMorphs)
{
    stateSet.setDefine("POSE_INFLUENCES", std::to_string(influences));
    if (hasMorphs)
        stateSet.removeDefine("POSE_NO_MORPHS");
    else
        stateSet.setDefine("POSE_NO_MORPHS");
}

} // namespace osgGpuAnimation
