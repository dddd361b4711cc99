// SPDX-License-Identifier: MIT
// What no glTF file can hold costs the element that has it, and nothing that is written is refused by the import.
#include "gltf/Export.h"
#include "gltf/Import.h"
#include "serializers/RoundTrip.h"
#include "support/ClipSets.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <gtest/gtest.h>
#include <osg/CameraView>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PrimitiveSetIndirect>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>

namespace osgGpuAnimation::gltf
{

namespace
{

using Warnings = std::vector<std::string>;
constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

/// The scene after export and import, which has to read it with these warnings alone. Null: the export refused it.
struct Reread
{
    explicit Reread(const osg::Node& scene, const Warnings& ofImport = {})
    {
        Report report(messages);
        const Result<std::string> glb = exportModel(scene, report);
        if (!glb) error = glb.error().message;
        if (!glb) return;
        model = valueOf(importModel(glb.value(), "", {}));
        EXPECT_EQ(model.messages.warnings, ofImport);
    }

    Messages messages;
    std::string error;
    ImportedModel model;
};

osg::PrimitiveSet* lengthsOf(GLint first, std::initializer_list<GLsizei> lengths)
{
    auto* const made = new osg::DrawArrayLengths(GL_LINE_STRIP, first);
    for (const GLsizei length : lengths)
        made->push_back(length);
    return made;
}

TEST(ExportedFaultsTest, primitivesBeyondTheVerticesCostThemselves)
{
    constexpr GLsizei billions = 2'000'000'000;
    const GLuint far[] = {0, 1, 4'000'000'000u};
    const std::pair<const char*, osg::ref_ptr<osg::PrimitiveSet>> cases[] = {
        {"two billion triangles", new osg::DrawArrays(GL_TRIANGLES, 0, billions)},
        {"two billion strips", new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, billions)},
        {"two billion points", new osg::DrawArrays(GL_POINTS, 0, billions)},
        {"a range from the last vertices on", new osg::DrawArrays(GL_TRIANGLES, 2, 3)},
        {"a first vertex below 0", new osg::DrawArrays(GL_LINES, -1, 2)},
        {"a count below 0", new osg::DrawArrays(GL_POINTS, 0, -1)},
        {"lengths of two billion", lengthsOf(0, {2, billions})},
        {"a length below 0", lengthsOf(0, {3, -3, 2})},
        {"lengths from a vertex below 0", lengthsOf(-2, {2})},
        {"an index beyond", new osg::DrawElementsUInt(GL_TRIANGLES, 3, far)},
        {"ranges in a buffer that is missing", new osg::DrawArraysIndirect(GL_TRIANGLES)},
        {"none", nullptr},
    };
    for (const auto& [name, primitives] : cases)
    {
        SCOPED_TRACE(name);
        const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("odd");
        geometry->getPrimitiveSetList().insert(geometry->getPrimitiveSetList().begin(), primitives);
        const auto before = std::chrono::steady_clock::now();
        const Reread reread(*geometry);
        EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(2));
        EXPECT_EQ(reread.messages.warnings,
                  Warnings{primitives ? "mesh \"odd\": indices beyond its vertices, or too few; a part is left out"
                                      : "mesh \"odd\": a primitive set is missing; left out"});
        EXPECT_EQ(reread.model.primitives.size(), 1u);
    }
}

/// A triangle that follows a joint of the set.
osg::ref_ptr<SkinnedGeometry> rigidTriangle(const AnimationSet& set, int joint)
{
    const osg::ref_ptr<SkinnedGeometry> made = plainTriangle<SkinnedGeometry>("");
    made->setRigidEntry(static_cast<unsigned short>(set.entryOfRigidJoint(joint)));
    applyCharacterProgram(*made->getOrCreateStateSet());
    return made;
}

/// A character of that many joints in a chain, "joint 0" and so on; a triangle follows the last one.
osg::ref_ptr<AnimatedCharacter> chainCharacter(int jointCount)
{
    std::vector<Joint> joints;
    for (int joint = 0; joint < jointCount; ++joint)
        joints.push_back({"joint " + std::to_string(joint), joint - 1, {}, joint});
    const auto set =
        AnimationSet::create({Skeleton::create(std::move(joints)).value(), {}, {jointCount - 1}, {}, {}}).value();
    const osg::ref_ptr<AnimatedCharacter> made = new AnimatedCharacter(set);
    made->addChild(rigidTriangle(*set, jointCount - 1));
    return made;
}

osg::ref_ptr<osg::Node> below(const osg::Matrixd& matrix, const std::string& name = "far")
{
    osg::ref_ptr<osg::MatrixTransform> made = new osg::MatrixTransform(matrix);
    made->setName(name);
    made->addChild(plainTriangle("triangle"));
    return made;
}

osg::ref_ptr<osg::Node> scaled(double scale, osg::ref_ptr<osg::Node> child)
{
    osg::ref_ptr<osg::MatrixTransform> made = new osg::MatrixTransform(osg::Matrixd::scale(scale, scale, scale));
    made->addChild(child);
    return made;
}

osg::Matrixd changedMatrix(int row, int column, double value)
{
    osg::Matrixd matrix = osg::Matrixd::translate(1, 2, 3);
    matrix(row, column) = value;
    return matrix;
}

/// Each column is longer than floats, no number is.
osg::Matrixd longColumns()
{
    osg::Matrixd matrix =
        osg::Matrixd::rotate(0.7, osg::Vec3d(0, 0, 1)) * osg::Matrixd::rotate(0.7, osg::Vec3d(1, 0, 0));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            matrix(row, column) = matrix(row, column) < 0.0 ? -3e38 : 3e38;
    return matrix;
}

template <typename Array, typename Element>
osg::ref_ptr<osg::Node> withVertices(const Element& first)
{
    const osg::ref_ptr<osg::Geometry> made = plainTriangle("triangle");
    const Element corners[] = {first, Element(1, 0, 0), Element(0, 0, 1)};
    made->setVertexArray(new Array(3, corners));
    return made;
}

osg::ref_ptr<osg::Node> withNormals()
{
    const osg::ref_ptr<osg::Geometry> made = plainTriangle("triangle");
    const osg::Vec3 normals[] = {{nan, 0, 0}, {0, 0, 0}, {3e38f, 3e38f, 3e38f}};
    made->setNormalArray(new osg::Vec3Array(3, normals), osg::Array::BIND_PER_VERTEX);
    return made;
}

osg::ref_ptr<osg::Node> withMaterial(const std::function<void(PbrMaterial&)>& change)
{
    const osg::ref_ptr<osg::Geometry> made = plainTriangle("triangle");
    PbrMaterial material;
    change(material);
    applyPbrMaterial(*made->getOrCreateStateSet(), material);
    return made;
}

osg::ref_ptr<osg::Node> withCutoff(float cutoff)
{
    const osg::ref_ptr<osg::Geometry> made = plainTriangle("triangle");
    made->getOrCreateStateSet()->addUniform(new osg::Uniform("alphaCutoff", cutoff));
    return made;
}

template <typename Child>
osg::ref_ptr<osg::Node> beside(osg::ref_ptr<Child> child)
{
    const osg::ref_ptr<osg::Group> made = new osg::Group;
    made->addChild(plainTriangle("triangle"));
    made->addChild(child);
    return made;
}

/// cone, outer: degrees; the outer one is set after the cone.
osg::ref_ptr<osg::Node> lit(float red, float inner = 20.0f, float outer = 30.0f, float cutoff = 30.0f)
{
    const osg::ref_ptr<PunctualLight> light = new PunctualLight(PunctualLight::Kind::Spot, 0);
    light->setDiffuse({red, 1, 1, 1});
    EXPECT_TRUE(light->setCone(inner, outer));
    light->setSpotCutoff(cutoff);
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(light);
    return beside(source);
}

osg::ref_ptr<osg::Node> seen(double fieldOfView)
{
    const osg::ref_ptr<osg::CameraView> view = new osg::CameraView;
    view->setFieldOfViewMode(osg::CameraView::VERTICAL);
    view->setFieldOfView(fieldOfView);
    return beside(view);
}

/// Two keys so close together that a spline's slope is beyond floats.
osg::ref_ptr<osg::Node> steepClip()
{
    const osg::ref_ptr<AnimatedCharacter> made = chainCharacter(2);
    ClipParts parts;
    parts.name = "steep";
    parts.form = Clip::Form::Spline;
    parts.jointCount = parts.trackCount = 2;
    parts.times = {0.0f, 1e-30f};
    JointTransform value, tangent;
    tangent.rotation = tangent.scale = glm::vec4(0.0f);
    value.translation.w = 1.0f; // slerp
    for (int keyframe = 0; keyframe < 2; ++keyframe)
        for (int track = 0; track < 2; ++track)
        {
            tangent.translation.x = track == 0 ? 1e10f : 0.0f;
            parts.data.insert(parts.data.end(), {value, tangent, tangent});
        }
    const Clip clip = valueOf(Clip::create(std::move(parts)));
    EXPECT_TRUE(made->setAnimationSet(made->getAnimationSet().withClips({clip}).value()));
    return made;
}

/// A clip that is sound by itself, below a transform that is, too.
osg::ref_ptr<osg::Node> farClip()
{
    const osg::ref_ptr<AnimatedCharacter> made = chainCharacter(2);
    const Channel away{Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0, 1}, {0, 0, 0, 1e12, 0, 0}};
    const Clip clip = clipOf(made->getAnimationSet().skeleton(), {away}, "far");
    EXPECT_TRUE(made->setAnimationSet(made->getAnimationSet().withClips({clip}).value()));
    made->setMatrix(osg::Matrixd::scale(1e8, 1e8, 1e8));
    return made;
}

/// A mesh that follows one joint by two inverse binds, one of them shifted.
osg::ref_ptr<osg::Node> boundTwice(float shift)
{
    AffineMatrix shifted;
    shifted.rows[0].w = shift;
    AnimationParts parts{Skeleton::create({{"joint", -1, {}, 0}}).value(), {}, {}, {}, {}};
    parts.skins = {{"one", {0}, {AffineMatrix()}}, {"other", {0}, {shifted}}};
    const auto set = AnimationSet::create(std::move(parts)).value();
    const osg::ref_ptr<SkinnedGeometry> mesh = rigidTriangle(*set, 0);
    const osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(3);
    const osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(3);
    for (unsigned int vertex = 0; vertex < 3; ++vertex)
    {
        (*entries)[vertex].set(static_cast<GLushort>(set->entryOfSkin(0, 0)),
                               static_cast<GLushort>(set->entryOfSkin(1, 0)), 0, 0);
        (*weights)[vertex].set(0.5f, 0.5f, 0.0f, 0.0f);
    }
    mesh->setInfluences(0, entries, weights);
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    character->addChild(mesh);
    return character;
}

TEST(ExportedFaultsTest, numbersThatNoFileCanHoldCostTheirElement)
{
    const char notFinite[] = "mesh \"triangle\": numbers that are not finite or beyond 1e18 are written as 0";
    const char limited[] = "materials[0]: factors out of their range, which are limited";
    const char lightFault[] = "light \"\": its colour or cone is out of range; left out";
    const char cameraFault[] = "camera \"\": it has no vertical field of view; left out";
    const char faulty[] = "transform \"far\": it is not affine or has numbers beyond 1e18; left out";
    const struct
    {
        const char* name;
        osg::ref_ptr<osg::Node> scene;
        const char* warning; ///< null: none
    } cases[] = {
        {"a place of 1e300", below(osg::Matrixd::translate(1e300, 0, 0)), faulty},
        {"a place of 1e30", below(osg::Matrixd::translate(1e30, 0, 0)), faulty},
        {"a place of 1e20 by a transform above", scaled(1e10, below(osg::Matrixd::translate(1e10, 0, 0))),
         "node \"far\": its transform and those above take it farther out than 1e18, the limit for float numbers; its "
         "own is left out"},
        {"an infinite place", below(osg::Matrixd::translate(HUGE_VAL, 0, 0)), faulty},
        {"a place that is no number", below(osg::Matrixd::translate(0, std::nan(""), 0)), faulty},
        {"columns longer than floats", below(longColumns()), faulty},
        {"a perspective along x", below(changedMatrix(0, 3, 2.0)), faulty},
        {"a perspective along z", below(changedMatrix(2, 3, 2.0)), faulty},
        {"a divisor of 2", below(changedMatrix(3, 3, 2.0)), faulty},
        {"a transform that flattens", below(osg::Matrixd::scale(0, 0, 0)), nullptr},
        {"a name that is no UTF-8", below(osg::Matrixd(), "\xff\xfe\x80 \x01 \""), nullptr},
        {"vertices", withVertices<osg::Vec3Array>(osg::Vec3(infinite, 0, 0)), notFinite},
        {"vertices of doubles", withVertices<osg::Vec3dArray>(osg::Vec3d(1e300, 0, 0)), notFinite},
        {"normals", withNormals(), notFinite},
        {"a factor that is no number", withMaterial([](auto& m) { m.metallic = nan; }), limited},
        {"a factor above 1", withMaterial([](auto& m) { m.clearcoat = 7.0f; }), limited},
        {"an infinite strength", withMaterial([](auto& m) { m.emissiveStrength = infinite; }), limited},
        {"a negative colour", withMaterial([](auto& m) { m.baseColor.set(-1, 2, nan, 1); }), limited},
        {"an infinite cutoff", withCutoff(infinite), "materials[0].alphaCutoff: it is not finite; written as 0"},
        {"a light without a colour", lit(nan), lightFault},
        {"a light of 3e38", lit(3e38f), lightFault},
        {"a light below 0", lit(-1.0f), lightFault},
        {"a cone below 0", lit(1.0f, 0.0f, 30.0f, -5.0f), lightFault},
        {"a cone within its inner one", lit(1.0f, 20.0f, 30.0f, 10.0f), nullptr},
        {"a camera of 180 degrees", seen(180.0), cameraFault},
        {"a camera of no number", seen(std::nan("")), cameraFault},
        {"a steep spline", steepClip(),
         "clip \"steep\": the translation of node \"joint 0\" has slopes beyond floats; left out"},
    };
    for (const auto& each : cases)
    {
        SCOPED_TRACE(each.name);
        const Reread reread(*each.scene);
        EXPECT_EQ(reread.error, "");
        EXPECT_EQ(reread.model.primitives.size(), 1u);
        EXPECT_EQ(reread.messages.warnings, each.warning ? Warnings{each.warning} : Warnings());
    }
}

/// Groups in one another, the innermost first; the last one is empty. They are taken apart one by one: OSG's
/// destructors recurse.
template <typename Group>
struct Nested
{
    explicit Nested(std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i)
        {
            groups.push_back(new Group);
            if (i > 0) groups[i]->addChild(groups[i - 1]);
        }
    }
    ~Nested()
    {
        while (!groups.empty())
        {
            groups.back()->removeChildren(0, groups.back()->getNumChildren());
            groups.pop_back();
        }
    }

    std::vector<osg::ref_ptr<Group>> groups;
};

TEST(ExportedFaultsTest, transformsDeeperThanTheImportReadsAreMerged)
{
    Nested<osg::MatrixTransform> nested(5000);
    for (const osg::ref_ptr<osg::MatrixTransform>& each : nested.groups)
        each->setMatrix(osg::Matrixd::translate(1, 0, 0));
    nested.groups.front()->addChild(plainTriangle("deep"));
    nested.groups[nested.groups.size() / 2]->addChild(plainTriangle("middle"));
    const Reread reread(*nested.groups.back());
    EXPECT_EQ(reread.messages.warnings, Warnings{"transform \"\": more than " + std::to_string(maxNodeDepth - 4) +
                                                 " nodes are above it; it and what is deeper are merged with the nodes "
                                                 "below"});
    ASSERT_EQ(reread.model.primitives.size(), 2u);
    const osg::MatrixList places = reread.model.primitives.back().geometry->getWorldMatrices();
    ASSERT_EQ(places.size(), 1u);
    const double x = places[0].getTrans().x();
    EXPECT_EQ(std::max(x, reread.model.primitives.front().geometry->getWorldMatrices()[0].getTrans().x()),
              static_cast<double>(nested.groups.size()));
}

TEST(ExportedFaultsTest, aHundredThousandNestedGroupsAreWritten)
{
    Nested<osg::Group> nested(100'000);
    nested.groups.front()->addChild(plainTriangle("deep"));
    const osg::ref_ptr<AnimatedCharacter> character = chainCharacter(2);
    nested.groups.front()->addChild(rigidTriangle(character->getAnimationSet(), 1));
    character->addChild(nested.groups.back());
    const Reread reread(*character);
    EXPECT_EQ(reread.messages.warnings, Warnings());
    EXPECT_EQ(reread.model.primitives.size(), 3u);
    character->removeChild(nested.groups.back());
}

TEST(ExportedFaultsTest, jointsDeeperThanTheImportReadsAreLeftOut)
{
    const osg::ref_ptr<AnimatedCharacter> character = chainCharacter(5000);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(character);
    scene->addChild(plainTriangle("triangle"));
    const Reread reread(*scene);
    EXPECT_EQ(reread.messages.warnings, Warnings{"character \"\": its joints would be deeper than " +
                                                 std::to_string(maxNodeDepth - 4) + " nodes; left out"});
    EXPECT_EQ(reread.model.primitives.size(), 1u);
}

// A skin of glTF has each joint once.
TEST(ExportedFaultsTest, aMeshMayFollowAJointByTwoInverseBinds)
{
    const Reread reread(*boundTwice(1.0f));
    EXPECT_EQ(reread.error, "");
    EXPECT_EQ(reread.messages.warnings, Warnings());
    EXPECT_EQ(reread.model.primitives.size(), 1u);
}

TEST(ExportedFaultsTest, inverseBindMatricesThatTakeVerticesFarOutAreTheIdentity)
{
    const Reread reread(*boundTwice(1e30f));
    EXPECT_EQ(reread.messages.warnings, // of the set's skin and of the mesh's own one
              Warnings(2, "inverse bind matrix of joint \"joint\": it takes vertices farther out than 1e18, the limit "
                          "for float numbers; the identity is written"));
    EXPECT_EQ(reread.model.primitives.size(), 1u);
}

TEST(ExportedFaultsTest, aClipThatTransformsTakeFarOutCostsItself)
{
    const Reread reread(*farClip(),
                        {"animations[0] \"far\": it takes joints or weights farther out than 1e18, the limit "
                         "for float numbers; clip skipped"});
    EXPECT_EQ(reread.messages.warnings, Warnings());
    EXPECT_EQ(reread.model.primitives.size(), 1u);
}

TEST(ExportedFaultsTest, aGroupBelowItselfIsWrittenOnce)
{
    const osg::ref_ptr<osg::Group> outer = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> inner = new osg::MatrixTransform(osg::Matrixd::translate(1, 0, 0));
    outer->setName("outer");
    outer->addChild(inner);
    inner->addChild(plainTriangle("triangle"));
    inner->addChild(outer);
    const Reread reread(*outer);
    EXPECT_EQ(reread.messages.warnings, Warnings{"node \"outer\" is below itself; what is below is left out"});
    EXPECT_EQ(reread.model.primitives.size(), 1u);
    inner->removeChild(outer);
}

TEST(ExportedFaultsTest, emptyScenesAndSharedGroupsOfMillionsOfPathsAreErrors)
{
    EXPECT_NE(Reread(*osg::ref_ptr<osg::Group>(new osg::Group)).error.find("nothing"), std::string::npos);
    Nested<osg::Group> nested(23);
    for (std::size_t level = 1; level < nested.groups.size(); ++level)
        nested.groups[level]->addChild(nested.groups[level - 1]);
    nested.groups.front()->addChild(plainTriangle("leaf"));
    const Reread reread(*nested.groups.back());
    EXPECT_EQ(reread.error, "more than 1000000 paths lead to its groups");
}

} // namespace

} // namespace osgGpuAnimation::gltf
