// SPDX-License-Identifier: MIT
// Numbers that are finite alone but overflow together.
#include "gltf/ImportedFile.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>

#include <cmath>
#include <string>

namespace osgGpuAnimation::gltf
{

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
