// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "looks/Panel.h"
#include "support/NotifyLog.h"
#include "support/StateModes.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/ShaderHook.h>

#include <osg/ColorMask>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/ShapeDrawable>

#include <string>
#include <vector>

// Characters below a host's programs, and the code of "Inside a host" in the guide shading.md, verbatim; see
// tests/house/GuidesTest.cpp.

namespace osgGpuAnimation
{

namespace
{

// clang-format off
// The host's logarithmic depth and fog, for its own program and for the kit's.
const char* const hostDepth = R"(#version 140
    void hostClipVertex(inout vec4 position, vec4 vertex)
    {
        position.z = (2.0 * log2(1.0 + max(position.w, 0.0)) / log2(1.0 + 1e6) - 1.0) * position.w;
    })";
const char* const hostFog = R"(#version 140
    in vec3 viewPosition;
    void hostFinalColor(inout vec4 color)
    {
        color.rgb = mix(vec3(0.6, 0.7, 0.8), color.rgb, exp(0.05 * viewPosition.z));
    })";

// The host's program. An osg::Program would do; this class stands for osgEarth's VirtualProgram, which is none.
class HostProgram : public osg::StateAttribute
{
public:
    explicit HostProgram(const char* color = hostFog) : _program(new osg::Program)
    {
        _program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(#version 140
            #extension GL_ARB_compatibility : enable
            void hostClipVertex(inout vec4 position, vec4 vertex);
            out vec3 viewPosition;
            void main()
            {
                vec4 eye = gl_ModelViewMatrix * gl_Vertex;
                viewPosition = eye.xyz;
                gl_Position = gl_ProjectionMatrix * eye;
                hostClipVertex(gl_Position, eye);
            })"));
        _program->addShader(new osg::Shader(osg::Shader::VERTEX, hostDepth));
        _program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 140
            void hostFinalColor(inout vec4 color);
            out vec4 fragmentColor;
            void main()
            {
                fragmentColor = vec4(0.3, 0.5, 0.2, 1.0);
                hostFinalColor(fragmentColor);
            })"));
        _program->addShader(new osg::Shader(osg::Shader::FRAGMENT, color));
    }
    HostProgram(const HostProgram& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY)
        : osg::StateAttribute(other, copyop), _program(other._program)
    {
    }
    META_StateAttribute(host, HostProgram, PROGRAM)
    int compare(const osg::StateAttribute& other) const override
    {
        COMPARE_StateAttribute_Types(HostProgram, other);
        COMPARE_StateAttribute_Parameter(_program);
        return 0;
    }
    void apply(osg::State& state) const override { _program->apply(state); }

protected:
    osg::ref_ptr<osg::Program> _program;
};
// clang-format on

/// A colour that depends on the place alone, whatever the material is.
const char* const hostColor = R"(#version 140
    in vec3 viewPosition;
    void hostFinalColor(inout vec4 color)
    {
        color = vec4(0.5 + 0.05 * viewPosition.xy, -0.1 * viewPosition.z - 0.5, 1.0);
    })";

/// A HostProgram that may skin.
class TestedProgram : public HostProgram
{
public:
    explicit TestedProgram(bool skins) : HostProgram(hostColor)
    {
        if (!skins) return;
        _program->removeShader(_program->getShader(0));
        _program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(#version 140
            #extension GL_ARB_compatibility : enable
            void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
            void hostClipVertex(inout vec4 position, vec4 vertex);
            out vec3 viewPosition;
            void main()
            {
                vec4 vertex = gl_Vertex;
                vec3 normal = gl_Normal;
                osgGpuAnimationSkin(vertex, normal);
                vec4 eye = gl_ModelViewMatrix * vertex;
                viewPosition = eye.xyz;
                gl_Position = gl_ProjectionMatrix * eye;
                hostClipVertex(gl_Position, eye);
            })"));
        _program->addShader(skinShader());
        bindSkinAttributes(*_program);
    }
    osg::Program& program() { return *_program; }
};

constexpr auto onOverride = on | override, onProtected = on | protect;

/// What the host sets above everything, besides its plain program for its own meshes.
enum class Kind
{
    Plain,    ///< a program that does not skin
    Skinning, ///< a program that skins
    Hooks,    ///< hooks with the host's depth and colour
};

struct Way
{
    const char* name;
    Kind kind;
    osg::StateAttribute::OverrideValue value;
};

const Way ways[] = {
    {"PlainOn", Kind::Plain, on},
    {"PlainOverride", Kind::Plain, onOverride},
    {"PlainProtected", Kind::Plain, onProtected},
    {"SkinningOn", Kind::Skinning, on},
    {"SkinningOverride", Kind::Skinning, onOverride},
    {"SkinningProtected", Kind::Skinning, onProtected},
    {"HooksOn", Kind::Hooks, on},
    {"HooksOverride", Kind::Hooks, onOverride},
    {"HooksProtected", Kind::Hooks, onProtected},
};

enum class Subject
{
    Character,
    Garment,
    Crowd,
    SharedCrowd, ///< whose instances share poses
    Together,    ///< characters that are drawn together
    Still,       ///< a mesh that does not move, with the kit's surface program
};

constexpr Subject subjects[] = {Subject::Character,   Subject::Garment,  Subject::Crowd,
                                Subject::SharedCrowd, Subject::Together, Subject::Still};

bool isMany(Subject subject)
{
    return subject >= Subject::Crowd && subject <= Subject::Together;
}

const osg::Matrixd places[] = {osg::Matrixd::translate(-1.2, 0, -0.8),
                               osg::Matrixd::rotate(0.5, osg::Y_AXIS) * osg::Matrixd::translate(0.6, 0.5, 0.9)};

void setHooks(osg::StateSet& state, osg::StateAttribute::OverrideValue value)
{
    state.setAttribute(new ShaderHook(ShaderHook::Place::ClipVertex, hostDepth), value);
    state.setAttribute(new ShaderHook(ShaderHook::Place::FinalColor, hostColor), value);
}

/// A wall half behind, half before the characters, and a box before them, of the host's; then the subject.
osg::ref_ptr<osg::Group> makeHostScene(osg::Node* subject, const Way* way)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group, own = new osg::Group;
    own->addChild(osg::createTexturedQuadGeometry(osg::Vec3(-6, 4, -6), osg::Vec3(12, 0, 0), osg::Vec3(0, -6, 12)));
    own->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(-1.2f, -1.5f, -1.2f), 0.9f)));
    own->getOrCreateStateSet()->setAttribute(new TestedProgram(false));
    scene->addChild(own);
    const osg::ref_ptr<osg::Group> below = new osg::Group;
    below->addChild(subject);
    scene->addChild(below);
    osg::StateSet& state = *below->getOrCreateStateSet();
    if (way && way->kind == Kind::Hooks) setHooks(state, way->value);
    if (way && way->kind != Kind::Hooks) state.setAttribute(new TestedProgram(way->kind == Kind::Skinning), way->value);
    if (way && way->kind == Kind::Skinning) state.setDefine("POSE_SKINNING_PROGRAM");
    return scene;
}

/// At rest without a clip.
osg::ref_ptr<AnimatedCharacter> makePosedPanel(bool isAtRest = false)
{
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    AnimationController& controller = character->getController();
    EXPECT_TRUE(controller.play("turn") && controller.seek(0.4));
    controller.pause();
    if (isAtRest) controller.stop();
    return character;
}

/// The subject's parts as plain geometry in the same pose, by the CPU.
osg::ref_ptr<osg::Node> makeBakedSubject(Subject subject, bool isAtRest = false)
{
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> character = makePosedPanel(isAtRest);
    for (const osg::Matrixd& place : places)
    {
        character->setMatrix(place);
        group->addChild(makeBaked(*character));
    }
    if (!isMany(subject)) group->removeChildren(1, 1);
    return group;
}

osg::ref_ptr<osg::Node> makeSubject(Subject subject)
{
    const osg::ref_ptr<AnimatedCharacter> character = makePosedPanel();
    character->setMatrix(places[0]);
    switch (subject)
    {
    case Subject::Character:
        return character;
    case Subject::Garment:
        character->removeChildren(0, 1);
        EXPECT_TRUE(character->wear(makePosedPanel()));
        return character;
    case Subject::Together:
    {
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        for (const osg::Matrixd& place : places)
        {
            group->addChild(osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES));
            static_cast<AnimatedCharacter&>(*group->getChild(group->getNumChildren() - 1)).setMatrix(place);
        }
        return group;
    }
    case Subject::Still:
    {
        const osg::ref_ptr<osg::Node> still = makeBaked(*character);
        applySurfaceProgram(*still->asGroup()->getChild(0)->getOrCreateStateSet(), true);
        return still;
    }
    default:
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(*character, {std::begin(places), std::end(places)});
        if (subject == Subject::SharedCrowd)
        {
            EXPECT_TRUE(crowd->getMeshes().setPixelError(0.25f));
            crowd->getMeshes().waitForLevels();
        }
        return crowd;
    }
    }
}

/// A host's visitor that sets its plain program on each mesh.
class MeshPrograms : public osg::NodeVisitor
{
public:
    MeshPrograms() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override
    {
        drawable.getOrCreateStateSet()->setAttribute(new TestedProgram(false));
        ++count;
    }
    int count = 0;
};

class HostGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene)
    {
        viewer().getCamera()->setProjectionMatrixAsPerspective(44, 1, 1, 1e6);
        // With the fixed pipeline OSG sets a Material here, which is an error in the core profile.
        viewer().getCamera()->getOrCreateStateSet()->clear();
        viewer().getCamera()->getStateSet()->setMode(GL_DEPTH_TEST, on);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        return ViewerGLTest::pictureOf(scene, {0.0, 0.1});
    }

    static bool hasHostsLook(Subject subject, const Way& way)
    {
        if (way.kind == Kind::Hooks) return true;
        return way.value == onOverride && (way.kind == Kind::Skinning || subject == Subject::Still);
    }

    /// As with the host's plain program, in the same pose.
    void expectPlainMeshesBelowASkinningProgram()
    {
        const osg::ref_ptr<osg::Group> scene = makeHostScene(makeSubject(Subject::Crowd), nullptr);
        osg::StateSet& above = *scene->getOrCreateStateSet();
        above.setAttribute(new TestedProgram(true), onOverride);
        above.setDefine("POSE_SKINNING_PROGRAM");
        const Way plain{"", Kind::Plain, on};
        const osg::ref_ptr<osg::Image> expected = pictureOf(makeHostScene(makeBakedSubject(Subject::Crowd), &plain));
        EXPECT_LE(Picture::pixelsDifferent(*expected, *pictureOf(scene)), thousandth);
    }

    void expectRestPosesUnderPlainPrograms()
    {
        static std::string warnings; // of both contexts: there is one in a process, maybe of another test
        const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
        osg::setNotifyHandler(log);
        const Way plain{"", Kind::Plain, on};
        for (const Subject subject : subjects)
        {
            if (subject == Subject::Still) continue;
            SCOPED_TRACE(static_cast<int>(subject));
            const osg::ref_ptr<osg::Image> rest = pictureOf(makeHostScene(makeBakedSubject(subject, true), &plain));
            const osg::ref_ptr<osg::Node> posed = makeSubject(subject);
            MeshPrograms visitor;
            posed->accept(visitor);
            EXPECT_GT(visitor.count, 0);
            EXPECT_LE(Picture::pixelsDifferent(*rest, *pictureOf(makeHostScene(posed, nullptr))), thousandth);
        }
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        warnings += log->text;
        const std::string words = "does not skin, so it shows the rest pose; see \"Inside a host\"";
        const std::size_t first = warnings.find(words);
        if (::testing::UnitTest::GetInstance()->test_to_run_count() == 1) // as in ctest
        {
            EXPECT_NE(first, std::string::npos) << warnings;
        }
        EXPECT_TRUE(first == std::string::npos || warnings.find(words, first + 1) == std::string::npos) << warnings;
    }

    static constexpr int thousandth = 128 * 128 / 1000;

    void expectHostsLookWhereSaid()
    {
        for (const Subject subject : subjects)
        {
            const Way plain{"", Kind::Plain, on};
            const osg::ref_ptr<osg::Image> baked = pictureOf(makeHostScene(makeBakedSubject(subject), &plain));
            const osg::ref_ptr<osg::Image> ours = pictureOf(makeHostScene(makeSubject(subject), nullptr));
            const osg::ref_ptr<osg::Image> none = pictureOf(makeHostScene(new osg::Group, nullptr));
            ASSERT_GT(Picture::pixelsDifferent(*baked, *none), 300);
            ASSERT_GT(Picture::pixelsDifferent(*baked, *ours), 300);
            for (const Way& way : ways)
            {
                SCOPED_TRACE(std::string(way.name) + ", subject " + std::to_string(static_cast<int>(subject)));
                const osg::ref_ptr<osg::Image> found = pictureOf(makeHostScene(makeSubject(subject), &way));
                const osg::Image& expected = hasHostsLook(subject, way) ? *baked : *ours;
                EXPECT_LE(Picture::pixelsDifferent(expected, *found), thousandth);
            }
        }
    }
};

// The scene of the guide: a character has the host's fog and stands on the host's ground.
TEST_F(HostGLTest, theStandInOfTheGuideDrawsAMixedScene)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(osg::createTexturedQuadGeometry(osg::Vec3(-6, 4, -6), osg::Vec3(12, 0, 0), osg::Vec3(0, -6, 12)));
    const osg::ref_ptr<AnimatedCharacter> panel = makePosedPanel();
    panel->setMatrix(osg::Matrix::translate(0, 0, 2.8));
    scene->addChild(panel);
    // clang-format off
osg::StateSet& state = *scene->getOrCreateStateSet();
state.setAttribute(new HostProgram);                                            // the host's own meshes
state.setAttribute(new ShaderHook(ShaderHook::Place::ClipVertex, hostDepth));   // osgGpuAnimation/looks/ShaderHook.h
state.setAttribute(new ShaderHook(ShaderHook::Place::FinalColor, hostFog));
    // clang-format on
    const osg::ref_ptr<osg::Image> found = pictureOf(scene);
    EXPECT_NO_GL_ERROR();
    scene->removeChildren(1, 1);
    const osg::ref_ptr<osg::Image> ground = pictureOf(scene);
    // Of a thousand pixels, the ground, which goes through the panel, hides the upper half.
    EXPECT_NEAR(Picture::pixelsDifferent(*ground, *found, 0.1f), 500, 150);
}

TEST_F(HostGLTest, charactersHaveTheHostsLookWhereItSaysSo)
{
    expectHostsLookWhereSaid();
    EXPECT_NO_GL_ERROR();
}

TEST_F(HostGLTest, aSkinningProgramLeavesPlainMeshesAsTheyAre)
{
    expectPlainMeshesBelowASkinningProgram();
    EXPECT_NO_GL_ERROR();
}

TEST_F(HostGLTest, aProgramOfAMeshThatDoesNotSkinShowsTheRestPoseUpright)
{
    expectRestPosesUnderPlainPrograms();
    EXPECT_NO_GL_ERROR();
}

/// OSG with the fixed pipeline, such as Debian's, causes GL errors of its own in the core profile, and reports them.
class CoreHostGLTest : public InCoreProfile<HostGLTest>
{
protected:
    void SetUp() override
    {
        osg::setNotifyHandler(new NotifyLog(osg::FATAL));
        InCoreProfile<HostGLTest>::SetUp();
    }
    void TearDown() override
    {
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        if (!IsSkipped() && !HasFatalFailure()) takeGLErrors();
        InCoreProfile<HostGLTest>::TearDown();
    }
};

TEST_F(CoreHostGLTest, charactersHaveTheHostsLookWhereItSaysSo)
{
    expectHostsLookWhereSaid();
}

TEST_F(CoreHostGLTest, aSkinningProgramLeavesPlainMeshesAsTheyAre)
{
    expectPlainMeshesBelowASkinningProgram();
}

TEST_F(CoreHostGLTest, aProgramOfAMeshThatDoesNotSkinShowsTheRestPoseUpright)
{
    expectRestPosesUnderPlainPrograms();
}

/// The programs above a character, from outside to inside: each skins, or not, and has a value.
struct Above
{
    bool skins;
    osg::StateAttribute::OverrideValue value;
};

struct AboveCase
{
    std::vector<Above> above;
    int drawn; ///< index of the program that draws the character; -1: the kit's
};

// Among programs that skin, OSG's rule of OVERRIDE and PROTECTED counts; the others count for the host's own meshes.
TEST_F(HostGLTest, theProgramsAboveReplaceTheKitsByOsgsRuleIfTheySkin)
{
    constexpr osg::StateAttribute::OverrideValue both = onOverride | onProtected;
    const AboveCase cases[] = {
        {{{true, on}}, -1},
        {{{true, onProtected}}, -1},
        {{{true, onOverride}}, 0},
        {{{true, both}}, 0},
        {{{false, onOverride}}, -1},
        {{{false, both}}, -1},
        {{{true, onOverride}, {true, on}}, 0},
        {{{true, onOverride}, {true, onOverride}}, 0},
        {{{true, onOverride}, {true, onProtected}}, -1},
        {{{true, onOverride}, {true, both}}, 1},
        {{{true, both}, {true, both}}, 1},
        {{{true, on}, {true, onOverride}}, 1},
        {{{true, onProtected}, {true, onOverride}}, 1},
        {{{false, onOverride}, {true, onOverride}}, 1},
        {{{false, both}, {true, on}}, -1},
        {{{true, onOverride}, {false, onOverride}}, 0},
        {{{true, onOverride}, {false, both}}, 0},
        {{{true, on}, {false, both}}, -1},
    };
    for (const bool isOsgProgram : {false, true})
        for (const AboveCase& each : cases)
        {
            std::vector<osg::ref_ptr<TestedProgram>> programs;
            std::vector<osg::ref_ptr<osg::StateSet>> stateSets; // osg::State does not keep them
            for (const Above& above : each.above)
            {
                programs.push_back(new TestedProgram(above.skins));
                stateSets.push_back(new osg::StateSet);
                osg::StateSet* const stateSet = stateSets.back();
                if (isOsgProgram)
                    stateSet->setAttribute(&programs.back()->program(), above.value);
                else
                    stateSet->setAttribute(programs.back(), above.value);
                if (above.skins && !isOsgProgram) stateSet->setDefine("POSE_SKINNING_PROGRAM");
                state().pushStateSet(stateSet);
            }
            const osg::ref_ptr<osg::StateSet> own = new osg::StateSet;
            applyCharacterProgram(*own);
            state().apply(own);
            ASSERT_TRUE(state().getLastAppliedProgramObject());
            const osg::Program* const found = state().getLastAppliedProgramObject()->getProgram();
            for (int i = 0; i < static_cast<int>(programs.size()); ++i)
                EXPECT_EQ(found == &programs[i]->program(), i == each.drawn) << (&each - cases) << ", " << i;
            state().popAllStateSets();
        }
    EXPECT_NO_GL_ERROR();
}

/// A hook of each place, and what it does to a white panel without lights, in front of black.
struct HookPlace
{
    const char* name;
    ShaderHook::Place place;
    const char* text;
    osg::Vec4 color; ///< of the panel
    double area;     ///< of the panel, as a multiple
};

const HookPlace hookPlaces[] = {
    {"EyeVertex", ShaderHook::Place::EyeVertex,
     "void hostEyeVertex(inout vec4 vertex, inout vec3 normal) { vertex.x *= 2.0; }", osg::Vec4(1, 1, 1, 1), 2},
    {"ClipVertex", ShaderHook::Place::ClipVertex,
     "void hostClipVertex(inout vec4 position, vec4 vertex) { position.y = 0.5 * position.y; }", osg::Vec4(1, 1, 1, 1),
     0.5},
    {"Material", ShaderHook::Place::Material,
     "void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 metallicRoughnessOcclusion,"
     " inout vec3 normal) { baseColor.r = 0.5; }",
     osg::Vec4(0.5f, 1, 1, 1), 1},
    {"LitColor", ShaderHook::Place::LitColor, "void hostLitColor(inout vec4 color) { color.g = 0.25; }",
     osg::Vec4(1, 0.25f, 1, 1), 1},
    {"FinalColor", ShaderHook::Place::FinalColor,
     "uniform float tone; void hostFinalColor(inout vec4 color) { color.b = tone; }", osg::Vec4(1, 1, 0.75f, 1), 1},
};

osg::ref_ptr<osg::Group> makeWhitePanel()
{
    const osg::ref_ptr<AnimatedCharacter> panel = makePanelCharacter();
    osg::StateSet& state = *panel->getChild(0)->getStateSet();
    state.setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    state.getOrCreateUniform("unlit", osg::Uniform::BOOL)->set(true);
    static_cast<osg::Material&>(*state.getAttribute(osg::StateAttribute::MATERIAL))
        .setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(panel);
    scene->getOrCreateStateSet()->addUniform(new osg::Uniform("tone", 0.75f));
    return scene;
}

TEST_F(HostGLTest, hooksOfEachPlaceAreCalled)
{
    const int area = Picture::pixelsDrawn(*pictureOf(makeWhitePanel()));
    ASSERT_GT(area, 300);
    for (const HookPlace& each : hookPlaces)
    {
        const osg::ref_ptr<osg::Group> scene = makeWhitePanel();
        scene->getStateSet()->setAttribute(new ShaderHook(each.place, each.text));
        const osg::ref_ptr<osg::Image> found = pictureOf(scene);
        EXPECT_NEAR(Picture::pixelsDrawn(*found), each.area * area, 0.1 * area) << each.name;
        EXPECT_LT((Picture::meanColor(*found) - each.color).length(), 0.02f) << each.name;
    }
    EXPECT_NO_GL_ERROR();
}

/// A panel of that material, lit from the side, in a surrounding with tone mapping.
osg::ref_ptr<osg::Group> makePbrPanel(const PbrMaterial& material)
{
    const osg::ref_ptr<AnimatedCharacter> panel = makePanelCharacter();
    osg::StateSet& state = *panel->getChild(0)->getStateSet();
    applyPbrMaterial(state, material);
    state.setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    light->getLight()->setPosition(osg::Vec4(-1, -1, 0.5f, 0));
    const osg::ref_ptr<Environment> scene = new Environment;
    scene->setToneMapping(true);
    scene->addChild(light);
    scene->addChild(panel);
    scene->getOrCreateStateSet()->setMode(GL_LIGHTING, on);
    scene->getStateSet()->setMode(GL_LIGHT0, on);
    return scene;
}

// In the light of the kit: a hook that gives a panel the values of another material makes the picture of that one, and
// the lit colour is linear.
TEST_F(HostGLTest, hooksOfMaterialsAreBeforeTheLightAndThoseOfLitColorsBeforeTheDisplay)
{
    PbrMaterial first, second;
    second.baseColor.set(0.6f, 0.2f, 0.1f, 1);
    second.emissive.set(0, 0.1f, 0.3f);
    second.metallic = 0.25f;
    second.roughness = 0.5f;
    const osg::ref_ptr<osg::Image> expected = pictureOf(makePbrPanel(second)), plain = pictureOf(makePbrPanel(first));
    ASSERT_GT(Picture::pixelsDifferent(*expected, *plain), 300);
    const auto pictureWith = [&](ShaderHook::Place place, const char* text)
    {
        const osg::ref_ptr<osg::Group> scene = makePbrPanel(first);
        scene->getStateSet()->setAttribute(new ShaderHook(place, text));
        return pictureOf(scene);
    };
    const osg::ref_ptr<osg::Image> hooked = pictureWith(ShaderHook::Place::Material, R"(
        void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 metallicRoughnessOcclusion, inout vec3 normal)
        {
            baseColor.rgb = vec3(0.6, 0.2, 0.1);
            emission = vec3(0.0, 0.1, 0.3);
            metallicRoughnessOcclusion.xy = vec2(0.25, 0.5);
        })");
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *hooked, 1.5f / 255), 0);
    const char* const lit = "void hostLitColor(inout vec4 color) { color.rgb = vec3(0.5); }";
    const char* const shown = "void hostFinalColor(inout vec4 color) { color.rgb = vec3(0.5); }";
    // Khronos PBR Neutral takes 0.04 off; 0.46 in sRGB is 0.71.
    EXPECT_NEAR(Picture::meanColor(*pictureWith(ShaderHook::Place::LitColor, lit)).g(), 0.708f, 0.01f);
    EXPECT_NEAR(Picture::meanColor(*pictureWith(ShaderHook::Place::FinalColor, shown)).g(), 0.5f, 0.01f);
    EXPECT_NO_GL_ERROR();
}

// A panel that writes depths alone hides what is behind it: at twice its width, or not at all where it is moved far
// away.
TEST_F(HostGLTest, hooksApplyInDepthPasses)
{
    const int area = Picture::pixelsDrawn(*pictureOf(makeWhitePanel()));
    const osg::ref_ptr<ShaderHook> hooks[] = {
        new ShaderHook(hookPlaces[0].place, hookPlaces[0].text),
        new ShaderHook(ShaderHook::Place::FinalColor, "void hostFinalColor(inout vec4 color) { gl_FragDepth = 1.0; }")};
    for (const osg::ref_ptr<ShaderHook>& hook : hooks)
    {
        const osg::ref_ptr<osg::Group> panel = makeWhitePanel(), scene = new osg::Group;
        panel->getStateSet()->setAttribute(new osg::ColorMask(false, false, false, false));
        panel->getStateSet()->setAttribute(hook);
        const osg::ref_ptr<osg::Geometry> wall =
            osg::createTexturedQuadGeometry(osg::Vec3(-6, 3, -6), osg::Vec3(12, 0, 0), osg::Vec3(0, 0, 12));
        wall->getOrCreateStateSet()->setRenderBinDetails(1, "RenderBin");
        scene->addChild(panel);
        scene->addChild(wall);
        EXPECT_NEAR(Picture::pixelsDrawn(*pictureOf(scene)), hook == hooks[0] ? 2 * area : 0, 0.2 * area);
    }
}

// A nearer hook replaces a farther one by OSG's rule; one without a text switches it off.
TEST_F(HostGLTest, nearerHooksReplaceFartherOnes)
{
    const auto hook = [](const char* value)
    {
        const std::string text = std::string("void hostFinalColor(inout vec4 color) { color.r = ") + value + "; }";
        return new ShaderHook(ShaderHook::Place::FinalColor, text);
    };
    const auto redUnder =
        [&](osg::StateAttribute::OverrideValue far, ShaderHook* near, osg::StateAttribute::OverrideValue nearValue)
    {
        const osg::ref_ptr<osg::Group> scene = makeWhitePanel();
        scene->getStateSet()->setAttribute(hook("0.25"), far);
        scene->getChild(0)->getOrCreateStateSet()->setAttribute(near, nearValue);
        return Picture::meanColor(*pictureOf(scene)).r();
    };
    EXPECT_NEAR(redUnder(on, hook("0.5"), on), 0.5, 0.01);
    EXPECT_NEAR(redUnder(onOverride, hook("0.5"), on), 0.25, 0.01);
    EXPECT_NEAR(redUnder(onOverride, hook("0.5"), onProtected), 0.5, 0.01);
    EXPECT_NEAR(redUnder(on, new ShaderHook(ShaderHook::Place::FinalColor), on), 1.0, 0.01);
}

// A faulty text names the hook, and the characters are not drawn.
TEST_F(HostGLTest, aFaultyHookIsNamed)
{
    const std::pair<const char*, const char*> faults[] = {
        {"void fog(inout vec4 color) {}", "expected a definition of void hostFinalColor(inout vec4 color), found none"},
        {"void hostFinalColor(inout vec4 color) { color = ", "\"ShaderHook hostFinalColor\""},
    };
    const int drawn = Picture::pixelsDrawn(*pictureOf(makeWhitePanel()));
    for (const auto& [text, message] : faults)
    {
        const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
        osg::setNotifyHandler(log);
        const osg::ref_ptr<osg::Group> scene = makeWhitePanel();
        scene->getStateSet()->setAttribute(new ShaderHook(ShaderHook::Place::FinalColor, text));
        EXPECT_EQ(Picture::pixelsDrawn(*pictureOf(scene)), text == faults[0].first ? drawn : 0);
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        EXPECT_NE(log->text.find(message), std::string::npos) << log->text;
        EXPECT_EQ(log->text.find("does not skin"), std::string::npos) << log->text;
    }
}

// The same text is the same program, in whatever hook, and a frame with hooks links nothing again.
TEST_F(HostGLTest, hooksWithTheSameTextCompileOnce)
{
    const auto linkedFor = [&](const char* text)
    {
        const osg::ref_ptr<osg::Group> scene = makeWhitePanel();
        scene->getStateSet()->setAttribute(new ShaderHook(ShaderHook::Place::FinalColor, text));
        const GlCallTrace trace(state());
        pictureOf(scene);
        return trace.count("glLinkProgram");
    };
    pictureOf(makeWhitePanel());
    const char* const first = "void hostFinalColor(inout vec4 color) { color.r = 0.1; }";
    EXPECT_EQ(linkedFor(first), 1);
    EXPECT_EQ(linkedFor(first), 0);
    EXPECT_EQ(linkedFor("void hostFinalColor(inout vec4 color) { color.r = 0.2; }"), 1);
}

} // namespace

} // namespace osgGpuAnimation
