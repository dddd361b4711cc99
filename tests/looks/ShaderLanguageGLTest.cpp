// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/Process.h"
#include "support/RandomSet.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/animation/constraints/ConstraintPlan.h>
#include <osgGpuAnimation/gpu/passes/EvaluationContext.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/environment/PrefilteredMap.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>

#include <ShaderSources.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Rows of values, one per parameter, in which each pair of values of two parameters occurs at least once: far fewer
/// rows than the product. counts: the number of values of each parameter; a value is in [0, count).
std::vector<std::vector<int>> pairwise(const std::vector<int>& counts)
{
    std::mt19937 random(1);
    using Place = std::pair<std::size_t, int>;
    std::vector<std::pair<Place, Place>> open;
    for (std::size_t first = 0; first < counts.size(); ++first)
        for (std::size_t second = first + 1; second < counts.size(); ++second)
            for (int a = 0; a < counts[first]; ++a)
                for (int b = 0; b < counts[second]; ++b)
                    open.push_back({{first, a}, {second, b}});
    const auto holds = [](const std::vector<int>& row, const auto& pair)
    { return row[pair.first.first] == pair.first.second && row[pair.second.first] == pair.second.second; };
    std::vector<std::vector<int>> rows;
    while (!open.empty())
    {
        std::vector<int> best;
        std::ptrdiff_t mostCovered = 0;
        for (int attempt = 0; attempt < 50; ++attempt)
        {
            std::vector<int> row;
            for (const int count : counts)
                row.push_back(std::uniform_int_distribution<int>(0, count - 1)(random));
            row[open.front().first.first] = open.front().first.second;
            row[open.front().second.first] = open.front().second.second;
            const auto covered =
                std::count_if(open.begin(), open.end(), [&](const auto& pair) { return holds(row, pair); });
            if (covered <= mostCovered) continue;
            mostCovered = covered;
            best = row;
        }
        open.erase(std::remove_if(open.begin(), open.end(), [&](const auto& pair) { return holds(best, pair); }),
                   open.end());
        rows.push_back(best);
    }
    return rows;
}

/// The sources of a program as GL gets them, each with its ending for glslangValidator.
using Sources = std::vector<std::pair<std::string, std::string>>;

std::set<Sources> linkedPrograms;

/// While it lives, keeps the sources of every program that is linked in a context, in linkedPrograms.
class LinkedPrograms
{
public:
    explicit LinkedPrograms(osg::GLExtensions& gl) : _gl(gl)
    {
        linkedPrograms.clear();
        extensions = &gl;
        real = std::exchange(gl.glLinkProgram,
                             [](GLuint program)
                             {
                                 linkedPrograms.insert(sourcesOf(program));
                                 real(program);
                             });
    }
    ~LinkedPrograms() { _gl.glLinkProgram = real; }
    LinkedPrograms(const LinkedPrograms&) = delete;
    LinkedPrograms& operator=(const LinkedPrograms&) = delete;

private:
    static Sources sourcesOf(GLuint program)
    {
        Sources sources;
        GLuint shaders[8];
        GLsizei count = 0, length = 0;
        extensions->glGetAttachedShaders(program, 8, &count, shaders);
        for (GLsizei i = 0; i < count; ++i)
        {
            GLint type = 0, size = 0;
            extensions->glGetShaderiv(shaders[i], GL_SHADER_TYPE, &type);
            extensions->glGetShaderiv(shaders[i], GL_SHADER_SOURCE_LENGTH, &size);
            std::string text(static_cast<std::size_t>(size), '\0');
            extensions->glGetShaderSource(shaders[i], size, &length, text.data());
            text.resize(static_cast<std::size_t>(length));
            sources.emplace_back(type == GL_VERTEX_SHADER ? ".vert" : ".frag", text);
        }
        return sources;
    }

    static inline decltype(osg::GLExtensions::glLinkProgram) real = nullptr;
    static inline osg::GLExtensions* extensions = nullptr;
    osg::GLExtensions& _gl;
};

/// What Khronos's reference compiler says of the programs: those that it refuses, with its message.
std::vector<std::string> refused(const std::set<Sources>& programs)
{
    // NVIDIA's compiler insists on the directive; the reference compiler does not.
    static const std::regex fixedPipeline(
        R"re(^(?!//).*\bgl_(Vertex\b|Normal\b|Color|MultiTex|ModelView|Projection|TextureMatrix|Light|FrontMaterial|Fog))re",
        std::regex::multiline);
    std::vector<std::string> messages;
    for (const Sources& program : programs)
    {
        const ScratchFolder folder;
        std::vector<std::string> arguments{"-l"};
        std::string text;
        for (const auto& [ending, source] : program)
        {
            arguments.push_back(folder.write(std::to_string(arguments.size()) + ending, source));
            text += source;
            if (std::regex_search(source, fixedPipeline) &&
                source.find("#extension GL_ARB_compatibility : enable") == std::string::npos)
                messages.push_back("a name of the fixed pipeline without GL_ARB_compatibility:\n" + source);
        }
        const Process compiler = Process::run("glslangValidator", arguments);
        if (compiler.status != 0) messages.push_back(compiler.out + compiler.err + text);
    }
    return messages;
}

/// Every program that the kit composes passes Khronos's reference compiler.
class ShaderLanguageGLTest : public GLTest
{
protected:
    osg::ref_ptr<osg::GraphicsContext::Traits> traits() const override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = GLTest::traits();
        if (_isCore) wanted->glContextProfileMask = 1;
        if (_isCore) wanted->glContextVersion = "3.3";
        return wanted;
    }

    void SetUp() override
    {
        if (Process::run("glslangValidator", {"--version"}).status == 0) return GLTest::SetUp();
        if (std::getenv("OSGGPUANIMATION_REQUIRE_GL")) FAIL() << "glslangValidator is required and is not there";
        GTEST_SKIP() << "no glslangValidator";
    }

    void changeToCoreProfile()
    {
        GLTest::TearDown();
        _isCore = true;
        GLTest::SetUp();
    }

    osg::GLExtensions& gl() { return *state().get<osg::GLExtensions>(); }

    /// Links the characters' program with the state's defines.
    void link(const osg::Program& program, const std::map<std::string, std::string>& defines)
    {
        const osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
        stateSet->setAttribute(const_cast<osg::Program*>(&program));
        for (const auto& [name, value] : defines)
            stateSet->setDefine(name, value);
        state().pushStateSet(stateSet);
        state().apply();
        state().popAllStateSets();
        state().apply();
    }

    /// Links the surfaces' programs, each pair of keys and defines at least once.
    void linkSurfaces()
    {
        const osg::ref_ptr<osg::Program> all = characterProgram();
        const auto& permutations = static_cast<const ShaderPermutations&>(*all);
        const std::uint8_t lights[] = {0, 1, 0xff}, points[] = {0, 2, 0xff}, maps[] = {0, 4, 0xfe};
        const char* const influences[] = {"", "1", "4", "8"};
        const char* const colors[] = {"", "1", "2"};
        for (const std::vector<int>& row : pairwise({2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 4, 4, 3, 2, 2, 2, 2}))
        {
            ShaderKey key;
            bool* const flags[] = {&key.isDepthOnly,      &key.isAlphaNeeded,  &key.isLit,         &key.hasFlatNormals,
                                   &key.hasSpecular,      &key.isTextured,     &key.hasClipPlanes, &key.hasShadowBias,
                                   &key.hasTextureMatrix, &key.hasShadowSplits};
            std::size_t i = 0;
            for (bool* flag : flags)
                *flag = row[i++] != 0;
            key.isCore = _isCore;
            key.hasClipPlanes = key.hasClipPlanes && !_isCore;
            key.hasTextureMatrix = key.hasTextureMatrix && !_isCore;
            key.lights = lights[row[i++]];
            key.pointLights = points[row[i++]];
            key.shadowMaps = maps[row[i++]];
            key.fog = static_cast<ShaderKey::Fog>(row[i++]);
            std::map<std::string, std::string> defines{{"POSE_INFLUENCES", influences[row[i]]},
                                                       {"POSE_COLORED", colors[row[i + 1]]}};
            for (auto define = defines.begin(); define != defines.end();)
                define = define->second.empty() ? defines.erase(define) : std::next(define);
            i += 2;
            for (const char* name : {"POSE_NO_MORPHS", "POSE_PLACED", "POSE_TINTED", "POSE_SKINNED"})
                if (row[i++] != 0) defines[name] = "1";
            link(*permutations.variant(key), defines);
        }
        link(*captureProgram(), {{"POSE_SKINNED", "1"}});
        for (const char* material : {"", "MATERIAL_PBR"})
            linkForHosts(permutations, material);
    }

    /// The kit's program with a hook of each place, and a host's with the kit's light.
    void linkForHosts(const ShaderPermutations& permutations, const char* material)
    {
        const char* const texts[] = {"void hostEyeVertex(inout vec4 vertex, inout vec3 normal) {}",
                                     "void hostClipVertex(inout vec4 position, vec4 vertex) {}",
                                     "void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 "
                                     "metallicRoughnessOcclusion, inout vec3 normal) {}",
                                     "void hostLitColor(inout vec4 color) {}",
                                     "void hostFinalColor(inout vec4 color) {}"};
        std::vector<osg::ref_ptr<ShaderHook>> hooks;
        for (unsigned int place = 0; place < ShaderHook::placeCount; ++place)
            hooks.push_back(new ShaderHook(static_cast<ShaderHook::Place>(place), texts[place]));
        std::map<std::string, std::string> defines{{"POSE_SKINNED", "1"}};
        if (*material) defines[material] = "1";
        for (const bool isDepthOnly : {false, true})
        {
            ShaderKey key;
            key.isCore = _isCore;
            key.isDepthOnly = key.isAlphaNeeded = isDepthOnly;
            for (std::size_t place = 0; place < hooks.size(); ++place)
                if (!isDepthOnly || hooks[place]->getPlace() != ShaderHook::Place::LitColor)
                    key.hooks[place] = hooks[place]->getShader();
            link(*permutations.variant(key), defines);
        }
        const osg::ref_ptr<osg::Program> lit = new osg::Program;
        lit->addShader(surfaceVertexShader());
        lit->addShader(skinShader());
        lit->addShader(lightShader(_isCore));
        lit->addShader(
            new osg::Shader(osg::Shader::FRAGMENT,
                            "#version 140\n"
                            "vec3 osgGpuAnimationLight(vec3 baseColor, vec3 emission, vec3 surface, vec3 normal);"
                            "vec3 osgGpuAnimationDisplay(vec3 color); vec3 osgGpuAnimationFog(vec3 color);"
                            "out vec4 color; void main() { vec3 light = osgGpuAnimationLight(vec3(0.5), "
                            "vec3(0.0), vec3(0.0, 1.0, 1.0), vec3(0.0, 0.0, 1.0)); "
                            "color = vec4(osgGpuAnimationFog(osgGpuAnimationDisplay(light)), 1.0); }"));
        bindSkinAttributes(*lit);
        for (const char* fog : {"0", "2"})
        {
            defines["DRAW_FOG"] = fog;
            defines["DRAW_SHADOW_MAPS"] = fog;
            link(*lit, defines);
        }
    }

    /// As osggpuanim composes it.
    static osg::ref_ptr<osg::Program> captureProgram()
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(skinShader());
        program->addShader(
            new osg::Shader(osg::Shader::VERTEX, std::string(shaders::version_glsl) + shaders::capture_vert));
        bindSkinAttributes(*program);
        return program;
    }

    /// Links the pose passes of both forms, each pair of a variant's members at least once.
    void linkPosePasses()
    {
        for (const std::vector<int>& row : pairwise({2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 5, 3, 3}))
        {
            ConstraintShape shape;
            PoseVariant variant;
            bool* const flags[] = {&variant.hasSplines,     &variant.hasSeveralSamples,
                                   &variant.hasWeights,     &variant.isRootLevel,
                                   &variant.hasRoots,       &variant.hasLayers,
                                   &variant.hasMasks,       &variant.hasAdditive,
                                   &variant.hasExactKeys,   &variant.hasCompactKeys,
                                   &variant.hasCorrections, &variant.hasLimits,
                                   &shape.hasSources,       &shape.hasCone,
                                   &shape.hasOffset,        &shape.hasDirections,
                                   &shape.hasFractions};
            std::size_t i = 0;
            for (bool* flag : flags)
                *flag = row[i++] != 0;
            variant.sampleCount = row[i++];
            variant.translationMotion = static_cast<PartMotion>(row[i++]);
            variant.scaleMotion = static_cast<PartMotion>(row[i++]);
            shape.isLookAt = variant.hasCorrections;
            shape.chainLength = 4;
            shape.midPlace = 2;
            shape.aboveLength = 1;
            using Stage = EvaluationContext::Stage;
            EvaluationContext context(gl());
            for (const Stage stage : {Stage::Pose, Stage::Mix, Stage::Constrain})
                EXPECT_TRUE(context.pass(stage, variant, shape).valid());
            context.release();
        }
        PosePipeline& pipeline = *PosePipeline::of(state());
        pipeline.options().form = PosePipeline::Form::Separate;
        const std::shared_ptr<const AnimationSet> set = makeRandomSet({});
        PoseBatch batch(set);
        batch.add(instructionAt(*set, 0, 0.5));
        EXPECT_TRUE(pipeline.evaluate(state(), batch, 0));
    }

    /// Links the program that prefilters surroundings.
    void linkPrefilter()
    {
        osg::ref_ptr<osg::Image> grey = new osg::Image;
        grey->allocateImage(2, 1, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE, 1);
        std::fill_n(grey->data(), 2, static_cast<unsigned char>(99));
        const auto radiance = RadianceCube::fromPanorama(*grey);
        ASSERT_TRUE(radiance);
        const osg::ref_ptr<PrefilteredMap> map = new PrefilteredMap(*radiance.value());
        map->apply(state());
        map->releaseGLObjects(&state());
    }

private:
    bool _isCore = false;
};

TEST_F(ShaderLanguageGLTest, everyProgramPassesTheReferenceCompiler)
{
    for (const bool isCore : {false, true})
    {
        SCOPED_TRACE(isCore ? "core profile" : "compatibility profile");
        if (isCore) changeToCoreProfile();
        if (HasFatalFailure() || IsSkipped()) return;
        const LinkedPrograms linked(gl());
        linkSurfaces();
        if (!isCore) linkPosePasses(); // which are the same in both
        linkPrefilter();
        EXPECT_GT(linkedPrograms.size(), isCore ? 20u : 60u);
        for (const std::string& message : refused(linkedPrograms))
            ADD_FAILURE() << message;
    }
    takeGLErrors(); // an OSG with the fixed pipeline makes errors of its own in the core profile
}

TEST_F(ShaderLanguageGLTest, theReferenceCompilerSeesWhatItLooksFor)
{
    const std::string version = "#version 140\n", extension = "#extension GL_ARB_compatibility : enable\n";
    EXPECT_EQ(refused({{{".frag", version + "int a = true;\nvoid main() {}\n"}}}).size(), 1u);
    EXPECT_EQ(refused({{{".frag", version + "void other();\nvoid main() { other(); }\n"}}}).size(), 1u);
    const std::string main = "void main() { gl_Position = gl_Vertex; }\n";
    EXPECT_EQ(refused({{{".vert", version + main}}}).size(), 1u);
    EXPECT_EQ(refused({{{".vert", version + extension + main}}}).size(), 0u);
}

} // namespace

} // namespace osgGpuAnimation
