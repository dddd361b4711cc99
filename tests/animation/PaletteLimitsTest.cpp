// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace osgGpuAnimation
{

namespace
{

/// Joints one below the other, each a unit along x of its parent.
std::vector<Joint> chainOf(int count)
{
    std::vector<Joint> joints;
    for (int joint = 0; joint < count; ++joint)
    {
        joints.push_back({"joint " + std::to_string(joint), joint - 1, {}, joint});
        joints.back().rest.translation.x = 1.0f;
    }
    return joints;
}

struct LimitsCase
{
    const char* name;
    int joints;
    std::function<void(AnimationParts&, std::vector<Joint>&)> change;
    bool isModest;
};

void scaleAll(std::vector<Joint>& joints, float scale)
{
    for (Joint& joint : joints)
        joint.rest.scale = glm::vec4(scale, scale, scale, 0.0f);
}

void addClip(AnimationParts& parts, const std::vector<Joint>& joints, Channel::Interpolation interpolation,
             double scale)
{
    const Skeleton skeleton = Skeleton::create(joints).value();
    ClipBuilder builder(skeleton, {});
    for (int joint = 0; joint < static_cast<int>(joints.size()); ++joint)
    {
        Channel channel{Channel::Path::Scale, interpolation, joint, {0.0, 1.0}, {}};
        const std::size_t numbers = interpolation == Channel::Interpolation::CubicSpline ? 18 : 6;
        channel.values.assign(numbers, scale);
        ASSERT_TRUE(builder.add(channel));
    }
    parts.clips.push_back(builder.build("grow"));
}

AffineMatrix scaling(float scale)
{
    AffineMatrix matrix;
    for (int axis = 0; axis < 3; ++axis)
        matrix.rows[static_cast<std::size_t>(axis)][axis] = scale;
    return matrix;
}

const LimitsCase limitsCases[] = {
    {"a usual chain", 60, [](AnimationParts&, std::vector<Joint>&) {}, true},
    {"a root of another unit", 60,
     [](AnimationParts&, std::vector<Joint>& joints) { joints[0].rest.scale = glm::vec4(100, 100, 100, 0); }, true},
    {"a large unit and its inverse", 60,
     [](AnimationParts& parts, std::vector<Joint>& joints)
     {
         joints[0].rest.scale = glm::vec4(1000, 1000, 1000, 0);
         for (int joint = 0; joint < 60; ++joint)
             parts.skins.front().inverseBinds[static_cast<std::size_t>(joint)] = scaling(0.001f);
     },
     true},
    {"a chain that grows by a half", 60, [](AnimationParts&, std::vector<Joint>& joints) { scaleAll(joints, 1.5f); },
     true},
    {"a chain that triples", 60, [](AnimationParts&, std::vector<Joint>& joints) { scaleAll(joints, 3.0f); }, false},
    {"a clip that triples", 60,
     [](AnimationParts& parts, std::vector<Joint>& joints)
     { addClip(parts, joints, Channel::Interpolation::Linear, 3.0); },
     false},
    {"a spline that doubles with steep tangents", 60,
     [](AnimationParts& parts, std::vector<Joint>& joints)
     { addClip(parts, joints, Channel::Interpolation::CubicSpline, 2.0); },
     false},
    {"a place far away", 3, [](AnimationParts&, std::vector<Joint>& joints) { joints[1].rest.translation.x = 1e30f; },
     false},
    {"huge inverse binds", 3,
     [](AnimationParts& parts, std::vector<Joint>&) { parts.skins.front().inverseBinds[1] = scaling(1e20f); }, false},
};

TEST(PaletteLimitsTest, areKnownFromTheScalesOfChains)
{
    for (const LimitsCase& each : limitsCases)
    {
        SCOPED_TRACE(each.name);
        std::vector<Joint> joints = chainOf(each.joints);
        AnimationParts parts{Skeleton::create(joints).value(), {}, {}, {}, {}};
        Skin skin;
        for (int joint = 0; joint < each.joints; ++joint)
        {
            skin.joints.push_back(joint);
            skin.inverseBinds.emplace_back();
        }
        parts.skins.push_back(skin);
        each.change(parts, joints);
        parts.skeleton = Skeleton::create(joints).value();
        const auto set = AnimationSet::create(std::move(parts));
        ASSERT_TRUE(set) << set.error().message;
        EXPECT_EQ(hasModestPalette(*set.value()), each.isModest);
        // The twin stays finite in any case.
        for (const double time : {0.0, 0.4})
        {
            PoseInstruction instruction;
            instruction.samples[0] = set.value()->sampleAt(set.value()->clips().empty() ? -1 : 0, time);
            std::vector<AffineMatrix> palette;
            Pose::evaluate(*set.value(), instruction, AffineMatrix(), palette);
            for (const AffineMatrix& entry : palette)
                EXPECT_TRUE(entry.isFinite());
            EXPECT_TRUE(Pose::jointToModel(*set.value(), instruction, joints.size() - 1).isFinite());
        }
    }
}

TEST(PaletteLimitsTest, productsOfLargeMatricesAreFinite)
{
    AffineMatrix large = scaling(3e38f);
    large.rows[0].y = -3e38f;
    large.rows[1].w = 3e38f;
    EXPECT_TRUE((large * large).isFinite());
    EXPECT_EQ((large * large).rows[0].x, 1e18f);
    EXPECT_EQ((large * large).rows[0].y, -1e18f);
    EXPECT_EQ((scaling(2.0f) * scaling(3.0f)).rows[2].z, 6.0f);
    JointTransform transform;
    transform.scale.x = INFINITY;
    transform.translation.y = -3e38f;
    EXPECT_TRUE(transform.toMatrix().isFinite());
}

} // namespace

} // namespace osgGpuAnimation
