// SPDX-License-Identifier: MIT
// Numbers that are finite alone but overflow together.
#include "gltf/Import.h"
#include "plugin/ModelBuilder.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr float huge = 3e38f;
const std::vector<float> farAway{0, 0, 0, huge, 0, 0, 0, -huge, 0};

bool isFinite(const JointTransform& transform)
{
    return transform.toMatrix().isFinite();
}

bool areFinite(const std::vector<JointTransform>& transforms)
{
    return std::all_of(transforms.begin(), transforms.end(),
                       [](const JointTransform& transform) { return isFinite(transform); });
}

/// True if the keyframes, the palette's static data, and the palette at several times of every clip are finite.
bool isFinite(const std::shared_ptr<const AnimationSet>& shared)
{
    const AnimationSet& set = *shared;
    bool good = areFinite(set.restPose());
    for (const Clip& clip : set.clips())
        good = good && areFinite(clip.data());
    for (const PaletteEntry& entry : set.palette())
        good = good && entry.inverseBind.isFinite() && entry.parentBind.isFinite();
    AnimationController controller(shared);
    for (std::size_t clip = 0; clip < set.clips().size(); ++clip)
    {
        good = good && controller.play(clip);
        for (const double part : {0.0, 0.3, 0.5, 0.9, 1.0})
        {
            controller.seek(part * set.clips()[clip].duration());
            std::vector<AffineMatrix> palette;
            Pose::evaluate(set, controller.instruction(), AffineMatrix(), palette);
            for (const AffineMatrix& matrix : palette)
                good = good && matrix.isFinite();
        }
    }
    return good;
}

bool isFinite(const ImportedModel& model)
{
    bool good = !model.set || isFinite(model.set);
    for (const ImportedPrimitive& primitive : model.primitives)
    {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*primitive.geometry->getVertexArray());
        for (const osg::Vec3& vertex : vertices)
            good = good && vertex.valid() && std::isfinite(vertex.length());
    }
    const osg::BoundingSphere bound = model.root->getBound();
    osg::ComputeBoundsVisitor bounds;
    model.root->accept(bounds);
    const osg::BoundingBox& box = bounds.getBoundingBox();
    return good && (!bound.valid() || std::isfinite(bound.radius2())) &&
           (!box.valid() || (std::isfinite(box.radius2()) && std::isfinite(box.center().length())));
}

/// A node that slides with a mesh over these positions.
struct Sliding : ModelBuilder
{
    explicit Sliding(const std::vector<float>& positions = {0, 0, 0, 1, 0, 0, 0, 1, 0})
    {
        arm = node("arm", -1, mesh({{"POSITION", floats(TINYGLTF_TYPE_VEC3, positions)}}));
        animation("slide");
        slide(arm);
    }
    void drive(const char* path, const std::vector<float>& values, const char* interpolation = "LINEAR")
    {
        animation("wild");
        channel(arm, path, {0, 1}, std::string(path) == "rotation" ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3, values,
                interpolation);
    }
    int arm = -1;
};

std::string clip(const char* path, const std::vector<float>& values, const char* interpolation)
{
    Sliding file;
    file.drive(path, values, interpolation);
    return file.text();
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

std::string morphed(float weight)
{
    Sliding file;
    file.primitive(0).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 1, 0, 0, 1, 0, 0})}}};
    file.model.meshes[0].weights = {weight};
    return file.text();
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
        {"morph weight", morphed(1e30f), beyond, false, 0, 0},
    };
    for (const ReachCase& reach : cases)
    {
        SCOPED_TRACE(reach.name);
        const Result<ImportedModel> model = importModel(reach.text, "", {});
        ASSERT_EQ(!model, reach.isRefused) << (model ? "" : model.error().message);
        std::string said = model ? "" : model.error().message;
        for (std::size_t i = 0; model && i < model.value().messages.warnings.size(); ++i)
            said += model.value().messages.warnings[i] + '\n';
        EXPECT_NE(said.find(reach.message), std::string::npos) << said;
        EXPECT_EQ(said.empty(), *reach.message == '\0') << said;
        if (!model) continue;
        EXPECT_TRUE(isFinite(model.value()));
        EXPECT_EQ(model.value().set ? model.value().set->clips().size() : 0u, reach.clips);
        EXPECT_EQ(model.value().primitives.size(), reach.primitives);
    }
}

} // namespace osgGpuAnimation::gltf
