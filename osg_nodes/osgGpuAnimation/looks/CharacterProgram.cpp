// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <osgGpuAnimation/gpu/detail/FixedPipeline.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>

#include <layout.glsl>
#include <ShaderSources.h>

#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

// The kit's own program gets the colours of the applied osg::Material instead.
constexpr const char* materialColors = "#define materialDiffuse baseColorFactor\n"
                                       "#define materialEmission emissiveFactor\n";

osg::ref_ptr<osg::Shader> makeLightShader(bool isCore)
{
    constexpr std::pair<const char*, int> modes[] = {
        {"DRAW_LIGHTS", 1}, {"DRAW_POINT_LIGHTS", 0}, {"DRAW_SHADOW_MAPS", 0}, {"DRAW_FOG", 0}, {"DRAW_ENCODED", 1}};
    std::string text = std::string(shaders::version_glsl) + materialColors + "#define GIVEN_MATERIAL\n" +
                       "#define DRAW_PUNCTUAL_LIGHTS 0\n#define DRAW_SPECULAR 1\n#define DRAW_SHADOW_BIAS 0\n" +
                       "#define DRAW_SHADOW_SPLITS 0\n";
    for (const auto& [name, value] : modes)
        text += std::string("#pragma import_defines(") + name + ")\n#ifndef " + name + "\n#define " + name + " " +
                std::to_string(value) + "\n#endif\n";
    text += std::string("#define DRAW_FIXED_PIPELINE ") + (isCore ? "0\n" : "1\n");
    // A core profile has a headlight.
    for (const char* name : {"DRAW_LIGHTS", "DRAW_FOG"})
        if (isCore) text += std::string("#undef ") + name + "\n#define " + name + " 0\n";
    for (const char* part : {shaders::color_glsl, shaders::material_glsl, shaders::pbr_glsl, shaders::environment_glsl,
                             shaders::light_glsl, shaders::linked_light_glsl})
        text += part;
    return new osg::Shader(osg::Shader::FRAGMENT, text);
}

osg::ref_ptr<osg::Program> makeProgram(const char* name, osg::Shader* skin)
{
    osg::ref_ptr<osg::Program> program = new ShaderPermutations(skin);
    program->setName(name);
    bindSkinAttributes(*program);
    return program;
}

void applyProgram(osg::StateSet& stateSet, osg::Program* program, osg::StateAttribute::GLModeValue value)
{
    stateSet.setAttributeAndModes(program, value);
    stateSet.getOrCreateUniform("baseColorTexture", osg::Uniform::SAMPLER_2D)->set(0);
    if (!stateSet.getUniform("alphaCutoff")) stateSet.addUniform(new osg::Uniform("alphaCutoff", 0.0f));
    if (!stateSet.getUniform("unlit")) stateSet.addUniform(new osg::Uniform("unlit", false));
}

} // namespace

osg::ref_ptr<osg::Shader> skinShader()
{
    static SharedObject<osg::Shader> shared;
    // GLSL 1.40 is enough for skinning and, in a compatibility context, keeps the names of the fixed pipeline.
    const auto make = []
    {
        return new osg::Shader(osg::Shader::VERTEX,
                               std::string("#version 140\n") + shaders::layout_glsl + shaders::skin_glsl);
    };
    return shared.get(make);
}

osg::ref_ptr<osg::Shader> surfaceVertexShader()
{
    static SharedObject<osg::Shader> shared;
    const std::string text = shaders::version_glsl + std::string("#define DRAW_SKINNED 1\n#define DRAW_COLOR 1\n") +
                             "#define DRAW_TEXTURE_MATRIX 0\n#define DRAW_CLIP_PLANES 0\n" + shaders::color_glsl +
                             shaders::character_vert;
    return shared.get([&] { return new osg::Shader(osg::Shader::VERTEX, text); });
}

osg::ref_ptr<osg::Shader> materialShader()
{
    static SharedObject<osg::Shader> shared;
    const std::string text = std::string("#version 140\n") + materialColors + shaders::material_glsl;
    return shared.get([&] { return new osg::Shader(osg::Shader::FRAGMENT, text); });
}

osg::ref_ptr<osg::Shader> lightShader(bool isCore)
{
    static SharedObject<osg::Shader> shared[2];
    return shared[isCore].get([isCore] { return makeLightShader(isCore); });
}

osg::ref_ptr<osg::Shader> lightShader()
{
    return lightShader(!hasFixedPipeline);
}

void bindSkinAttributes(osg::Program& program)
{
    program.addBindAttribLocation("poseEntries0", POSE_ENTRIES_0_LOCATION);
    program.addBindAttribLocation("poseWeights0", POSE_WEIGHTS_0_LOCATION);
    program.addBindAttribLocation("poseEntries1", POSE_ENTRIES_1_LOCATION);
    program.addBindAttribLocation("poseWeights1", POSE_WEIGHTS_1_LOCATION);
    program.addBindAttribLocation("poseInstanceRow0", POSE_INSTANCE_ROW_0_LOCATION);
    program.addBindAttribLocation("poseInstanceRow1", POSE_INSTANCE_ROW_1_LOCATION);
    program.addBindAttribLocation("poseInstanceRow2", POSE_INSTANCE_ROW_2_LOCATION);
    program.addBindAttribLocation("poseInstancePose", POSE_INSTANCE_POSE_LOCATION);
    program.addBindAttribLocation("poseTangent", POSE_TANGENT_LOCATION);
    program.addBindAttribLocation("poseCoordinates", POSE_COORDINATES_LOCATION);
    program.addBindAttribLocation("posePart", POSE_PART_LOCATION);
}

osg::ref_ptr<osg::Program> characterProgram()
{
    static SharedObject<osg::Program> shared;
    return shared.get([] { return makeProgram("osgGpuAnimation character", skinShader()); });
}

void applyCharacterProgram(osg::StateSet& stateSet)
{
    // osgShadow's casting cameras override the program with none, which would draw the bind pose.
    applyProgram(stateSet, characterProgram(), osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    if (!stateSet.getTextureAttribute(0, osg::StateAttribute::TEXTURE))
        stateSet.setTextureAttributeAndModes(0, whiteTexture());
}

osg::ref_ptr<osg::Program> surfaceProgram()
{
    static SharedObject<osg::Program> shared;
    return shared.get([] { return makeProgram("osgGpuAnimation surface", nullptr); });
}

void applySurfaceProgram(osg::StateSet& stateSet, bool colored)
{
    applyProgram(stateSet, surfaceProgram(), osg::StateAttribute::ON);
    if (colored) stateSet.setDefine("POSE_COLORED", "1");
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
