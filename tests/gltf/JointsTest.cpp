// SPDX-License-Identifier: MIT
#include "gltf/import/Joints.h"
#include "gltf/import/NodeTransform.h"
#include "gltf/ImportedFile.h"
#include "gltf/ModelBuilder.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>

#include <cmath>
#include <random>
#include <set>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

struct Built
{
    explicit Built(const ModelBuilder& file)
        : tree(buildNodeTree(file.model, {}).value()), joints(buildJoints(file.model, tree).value())
    {
    }

    NodeTree tree;
    Joints joints;
};

std::set<std::string> jointNames(const ModelBuilder& file)
{
    std::set<std::string> names;
    const Built built(file);
    for (const Joint& joint : built.joints.skeleton.joints())
        names.insert(joint.name);
    return names;
}

using Names = std::set<std::string>;

struct MatrixCase
{
    const char* name;
    glm::dmat4 matrix;
    bool shears;
};

const glm::dmat4 unit(1.0);
const glm::dmat4 turn = glm::rotate(unit, 1.1, glm::normalize(glm::dvec3(1, -2, 0.5)));
const glm::dmat4 place = glm::translate(unit, glm::dvec3(3, -4, 5));
const glm::dmat4 uneven = glm::scale(unit, glm::dvec3(2, 0.25, 1.5));

const MatrixCase cases[] = {
    {"nothing", glm::dmat4(1.0), false},
    {"translation", place, false},
    {"rotation", turn, false},
    {"half a turn", glm::rotate(unit, std::acos(-1.0), glm::dvec3(0, 1, 0)), false},
    {"all three", place* turn* uneven, false},
    {"mirrored", place* turn* glm::scale(unit, glm::dvec3(-1, 1, 1)), false},
    {"point reflection", glm::scale(unit, glm::dvec3(-1.0)), false},
    {"flat", turn* glm::scale(unit, glm::dvec3(1, 0, 2)), false},
    {"a line", turn* glm::scale(unit, glm::dvec3(0, 0, 2)), false},
    {"a point", place* glm::scale(unit, glm::dvec3(0.0)), false},
    {"scaled after turning", place* uneven* turn, true},
    {"mirrored and sheared", uneven* turn* glm::scale(unit, glm::dvec3(1, -1, 1)), true},
    {"shear", glm::dmat4(1, 0, 0, 0, 0.7, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1), true},
    {"sheared flat", glm::scale(unit, glm::dvec3(2, 1, 0)) * turn, true},
    {"tiny", glm::scale(unit, glm::dvec3(1e-6)) * turn, false},
    {"tiny and sheared", glm::scale(unit, glm::dvec3(1e-6, 2e-6, 1e-6)) * turn, true},
};

tinygltf::Node nodeOf(const glm::dmat4& matrix)
{
    tinygltf::Node node;
    for (int i = 0; i < 16; ++i)
        node.matrix.push_back(matrix[i / 4][i % 4]);
    return node;
}

/// Largest difference of an element, relative to the largest element of its kind.
double difference(const glm::dmat4& expected, const glm::dmat4& found)
{
    double largest[] = {1e-30, 1.0}, worst[] = {0.0, 0.0}; // of rotation and scale, of the translation
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
        {
            const int kind = column / 3;
            largest[kind] = std::max(largest[kind], std::abs(expected[column][row]));
            worst[kind] = std::max(worst[kind], std::abs(expected[column][row] - found[column][row]));
        }
    return std::max(worst[0] / largest[0], worst[1] / largest[1]);
}

void expectSame(const MatrixCase& wanted)
{
    SCOPED_TRACE(wanted.name);
    const NodeTransform transform = decompose(nodeOf(wanted.matrix));
    EXPECT_EQ(transform.outer.has_value(), wanted.shears);
    glm::dmat4 product = transform.inner.toMatrix().toColumns();
    EXPECT_NEAR(glm::length(transform.inner.rotation), 1.0f, 1e-6f);
    if (transform.outer)
    {
        product = transform.outer->toMatrix().toColumns() * product;
        EXPECT_EQ(glm::vec3(transform.inner.translation), glm::vec3(0));
        EXPECT_EQ(glm::vec3(transform.inner.scale), glm::vec3(1));
    }
    EXPECT_LE(difference(wanted.matrix, product), 1e-6); // a few roundings to float
}

} // namespace

TEST(JointsTest, skinJointsAndTheirAncestors)
{
    ModelBuilder file;
    const int root = file.node("root");
    file.node("beside", root, file.triangle()); // its only joint is an ancestor: stays still
    const int between = file.node("between", root);
    const int hip = file.node("hip", between);
    file.node("socket", hip); // nothing depends on it
    EXPECT_EQ(jointNames(file), Names{}) << "without a skin or clip";
    file.at(file.node("body", hip, file.skinnedTriangle())).skin = file.skin({hip});
    EXPECT_EQ(jointNames(file), (Names{"root", "between", "hip"}));
}

TEST(JointsTest, targetsOfClipsAndTheMeshesBelow)
{
    ModelBuilder file;
    const int root = file.node("root");
    const int arm = file.node("arm", root);
    file.node("sword", file.node("hand", arm), file.triangle());
    file.node("empty", arm);
    file.node("stone", root, file.triangle());
    file.slidingClip("wave", arm);
    EXPECT_EQ(jointNames(file), (Names{"root", "arm", "hand", "sword"}));
    const Built built(file);
    const Skeleton& skeleton = built.joints.skeleton;
    EXPECT_EQ(rigidJoints(file.model, built.tree, built.joints),
              (std::vector<int>{skeleton.findJoint("sword"), skeleton.findJoint("root")}));
    EXPECT_EQ(built.joints.ofStillMeshes, skeleton.findJoint("root")) << "the stone follows it in a crowd";
    const auto set = AnimationSet::create({skeleton, {}, rigidJoints(file.model, built.tree, built.joints), {}, {}});
    EXPECT_EQ(valueOf(set)->paletteSize(), skeleton.jointCount()) << "at no cost";
    ModelBuilder beside;
    beside.slidingClip("wave", beside.node("arm", -1, beside.triangle()));
    EXPECT_EQ(jointNames(beside), Names{"arm"});
    beside.node("stone", beside.node("ground"), beside.triangle());
    EXPECT_EQ(jointNames(beside), (Names{"arm", ""})) << "which does not move";
    ModelBuilder morphing;
    const int mesh = morphing.triangle();
    morphing.primitive(mesh).targets.push_back(morphing.primitive(mesh).attributes);
    morphing.node("face", -1, mesh);
    EXPECT_EQ(jointNames(morphing), Names{"face"});
}

TEST(JointsTest, aSkinFollowsJointsOutsideTheScene)
{
    ModelBuilder file;
    const int root = file.node("root");
    const int hip = file.node("hip", root);
    file.model.scenes[0].nodes.clear();
    file.at(file.node("body", -1, file.skinnedTriangle())).skin = file.skin({hip});
    const Built built(file);
    EXPECT_EQ(built.joints.skeleton.jointCount(), 2u);
    EXPECT_TRUE(built.tree.drawn[2]);
    EXPECT_FALSE(built.tree.drawn[0]);
}

TEST(JointsTest, aShearedNodeTakesTwoJoints)
{
    ModelBuilder file;
    const int sheared = file.node("sheared");
    file.at(sheared).matrix = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1};
    const int tip = file.node("tip", sheared);
    file.skin({tip});
    const Built built(file);
    const Skeleton& skeleton = built.joints.skeleton;
    ASSERT_EQ(skeleton.jointCount(), 3u);
    EXPECT_TRUE(built.joints.isSheared[static_cast<std::size_t>(sheared)]);
    const int inner = built.joints.ofNode[static_cast<std::size_t>(sheared)];
    EXPECT_EQ(inner, skeleton.jointOfSourceNode(sheared));
    const int outer = skeleton.joint(static_cast<std::size_t>(inner)).parent;
    ASSERT_GE(outer, 0);
    EXPECT_EQ(skeleton.joint(static_cast<std::size_t>(outer)).sourceNode, -1);
    EXPECT_EQ(skeleton.joint(static_cast<std::size_t>(built.joints.ofNode[1])).parent, inner);
}

TEST(NodeTransformTest, aMatrixIsOneJointOrTwo)
{
    for (const MatrixCase& wanted : cases)
        expectSame(wanted);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-2.0, 2.0);
    for (int i = 0; i < 1000; ++i)
    {
        glm::dmat4 matrix(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                matrix[column][row] = number(random);
        expectSame({"random", matrix, true});
    }
}

TEST(NodeTransformTest, rotationsAreMadeUnit)
{
    tinygltf::Node node;
    node.rotation = {0, 0, 10, 0};
    EXPECT_EQ(decompose(node).inner.rotation, glm::vec4(0, 0, 1, 0));
    node.rotation = {0, 0, 0, 0};
    EXPECT_EQ(decompose(node).inner.rotation, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(localMatrix(node), glm::dmat4(1.0));
}

TEST(NodeTransformTest, bothWaysOfOneNodeAgree)
{
    tinygltf::Node node;
    node.translation = {1, 2, 3};
    node.rotation = {0.1, -0.4, 0.2, 0.7};
    node.scale = {2, -1, 0.5};
    const NodeTransform transform = decompose(node);
    EXPECT_LE(difference(localMatrix(node), transform.inner.toMatrix().toColumns()), 1e-6);
    EXPECT_LE(difference(localMatrix(node), decompose(nodeOf(localMatrix(node))).inner.toMatrix().toColumns()), 1e-6);
}

// Numbers that are finite alone but overflow together.

namespace
{

constexpr float huge = 3e38f;
const std::vector<float> farAway{0, 0, 0, huge, 0, 0, 0, -huge, 0};

/// True if the keyframes, the palette in the middle of every clip, and the bounds are finite.
bool isFinite(const ImportedModel& model)
{
    bool good = true;
    for (std::size_t clip = 0; model.set && clip < model.set->clips().size(); ++clip)
    {
        for (const JointTransform& transform : model.set->clips()[clip].data())
            good = good && transform.toMatrix().isFinite();
        std::vector<AffineMatrix> palette;
        Pose::evaluate(*model.set, instructionAt(*model.set, static_cast<int>(clip), 0.3), AffineMatrix(), palette);
        for (const AffineMatrix& matrix : palette)
            good = good && matrix.isFinite();
    }
    const osg::BoundingSphere bound = model.root->getBound();
    osg::ComputeBoundsVisitor bounds;
    model.root->accept(bounds);
    const osg::BoundingBox& box = bounds.getBoundingBox();
    return good && (!bound.valid() || std::isfinite(bound.radius2())) && (!box.valid() || std::isfinite(box.radius2()));
}

/// A node that slides with a mesh over these positions.
struct Sliding : ModelBuilder
{
    explicit Sliding(const std::vector<float>& positions = {0, 0, 0, 1, 0, 0, 0, 1, 0})
    {
        arm = node("arm", -1, mesh({{"POSITION", floats(TINYGLTF_TYPE_VEC3, positions)}}));
        slidingClip("slide", arm);
    }
    std::string wild(const char* path, int type, const std::vector<float>& values, const char* interpolation)
    {
        animation("wild");
        channel(arm, path, {0, 1}, type, values, interpolation);
        return text();
    }
    int arm = -1;
};

std::string clip(const char* path, const std::vector<float>& values, const char* interpolation)
{
    const int type = std::string(path) == "rotation" ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
    return Sliding().wild(path, type, values, interpolation);
}

/// An arm with a scale and a place, below a node with the same scale.
std::string restBelowScales(double scale, double place = 0.0)
{
    Sliding file;
    const int above = file.node("above");
    file.at(above).scale = {scale, scale, scale};
    file.at(above).children = {file.arm};
    file.at(file.arm).scale = {scale, scale, scale};
    file.at(file.arm).translation = {place, 0.0, 0.0};
    file.model.scenes[0].nodes = {above};
    return file.text();
}

std::string stillAt(const std::vector<float>& positions, double scale)
{
    ModelBuilder file;
    const int node = file.node("rock", -1, file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, positions)}}));
    file.at(node).scale = {scale, scale, scale};
    return file.text();
}

std::string skinned(float inverseBind)
{
    ModelBuilder file;
    const int body = file.node("body", -1, file.skinnedTriangle());
    const int hip = file.node("hip"), knee = file.node("knee", hip);
    file.at(body).skin = file.skin({hip, knee});
    std::vector<float> matrices;
    for (int i = 0; i < 2; ++i)
        matrices.insert(matrices.end(), {inverseBind, 0, 0, 0, 0, inverseBind, 0, 0, 0, 0, inverseBind, 0, 0, 0, 0, 1});
    file.model.skins[0].inverseBindMatrices = file.floats(TINYGLTF_TYPE_MAT4, matrices);
    return file.text();
}

/// A mesh with one target, whose vertices the target moves by that; at rest and at the end of a clip.
std::string morphed(float offset, float weightAtRest, float weight)
{
    Sliding file;
    file.primitive(0).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {offset, 0, 0, 1, 0, 0, 1, 0, 0})}}};
    file.model.meshes[0].weights = {weightAtRest};
    return file.wild("weights", TINYGLTF_TYPE_SCALAR, {0, weight}, "LINEAR");
}

struct ReachCase
{
    const char* name;
    std::string text;
    const char* message; ///< in the error or a warning
    bool isRefused;
    std::size_t clips;      ///< the remaining ones
    std::size_t primitives; ///< the remaining ones
};

const char* const beyond = "farther out than 1e18";

} // namespace

TEST(TransformBoundTest, nothingBeyondFloatNumbersComesThrough)
{
    const ReachCase cases[] = {
        {"modest", stillAt({0, 0, 0, 1, 0, 0, 0, 1, 0}, 1e17), "", false, 0, 1},
        {"vertices", stillAt(farAway, 1.0), beyond, false, 0, 0},
        {"vertices by scale", stillAt({0, 0, 0, 1, 0, 0, 0, 1, 0}, 1e30), "nodes[0]", false, 0, 0},
        {"vertices on a joint", Sliding(farAway).text(), beyond, false, 1, 0},
        {"scale of a clip", clip("scale", {huge, huge, huge, -huge, -huge, -huge}, "LINEAR"), "animations[1]", false, 1,
         1},
        {"translation of a clip", clip("translation", {huge, 0, 0, 0, 0, 0}, "STEP"), "animations[1]", false, 1, 1},
        {"tangents",
         clip("translation", {huge, 0, 0, 0, 0, 0, huge, 0, 0, huge, 0, 0, 0, 0, 0, huge, 0, 0}, "CUBICSPLINE"),
         "animations[1]", false, 1, 1},
        {"tangents of rotations",
         clip("rotation",
              {0, 0, 0, 0, 0, 0, 0, 1, huge, huge, huge, huge, huge, huge, huge, huge, 0, 0, 1, 0, 0, 0, 0, 0},
              "CUBICSPLINE"),
         "animations[1]", false, 1, 1},
        {"product of scales", restBelowScales(1e30), "nodes[", true, 0, 0},
        {"place below a scale", restBelowScales(1e8, 1e11), "nodes[", true, 0, 0},
        {"nearer place below a scale", restBelowScales(1e8, 1e9), "", false, 1, 1},
        {"inverse bind", skinned(1e30f), "skins[0].inverseBindMatrices", true, 0, 0},
        {"tiny inverse bind", skinned(1e-30f), "", false, 0, 1},
        {"morph weight", morphed(1, 1e30f, 0), beyond, false, 1, 0},
        {"morph weight of a clip", morphed(1e10f, 0, 0.5e10f), beyond, false, 2, 0},
        {"morph weight below 0", morphed(1e10f, 0, -0.5e10f), beyond, false, 2, 0},
        {"modest weights", morphed(1e10f, 0, -0.5f), "", false, 2, 1},
    };
    for (const ReachCase& reach : cases)
    {
        SCOPED_TRACE(reach.name);
        if (reach.isRefused)
        {
            expectRefused(reach.text, reach.message);
            continue;
        }
        const ImportedModel model = imported(reach.text);
        std::string said;
        for (const std::string& warning : model.messages.warnings)
            said += warning + '\n';
        EXPECT_NE(said.find(reach.message), std::string::npos) << said;
        EXPECT_EQ(said.empty(), *reach.message == '\0') << said;
        EXPECT_TRUE(isFinite(model));
        EXPECT_EQ(model.set ? model.set->clips().size() : 0u, reach.clips);
        EXPECT_EQ(model.primitives.size(), reach.primitives);
    }
}

// A bound of a clip is that of its largest axis, and a spline may reach the sum of its value and tangents.
TEST(TransformBoundTest, boundsOfClipsTakeTheLargestAxisAndTheTangents)
{
    Joint joint{"joint", -1, {}, 0};
    joint.rest.scale = {1, -4, 2, 0};
    joint.rest.translation = {3, 4, 0, 0};
    const Skeleton skeleton = Skeleton::create({joint}).value();
    EXPECT_EQ(boundsAtRest(skeleton)[0].stretch, 4.0);
    EXPECT_EQ(boundsAtRest(skeleton)[0].distance, 5.0);
    ClipParts parts;
    parts.name = "spline";
    parts.form = Clip::Form::Spline;
    parts.jointCount = parts.trackCount = 1;
    parts.times = {0, 1};
    for (int i = 0; i < 6; ++i) // value, tangent before, tangent after
    {
        JointTransform transform;
        transform.translation = {0, i == 4 ? 10 : 1, 0, 0};
        transform.scale = {1, 1, i == 5 ? -20 : 2, 0};
        parts.data.push_back(transform);
    }
    const Result<Clip> clip = Clip::create(parts);
    ASSERT_TRUE(clip) << clip.error().message;
    EXPECT_EQ(boundsOfClip(skeleton, clip.value())[0].distance, 12.0);
    EXPECT_EQ(boundsOfClip(skeleton, clip.value())[0].stretch, 24.0);
}

} // namespace osgGpuAnimation::gltf
