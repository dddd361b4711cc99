// SPDX-License-Identifier: MIT
#include "support/RandomConstraints.h"

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

namespace osgGpuAnimation
{

namespace
{

float anyNumber(std::mt19937& random, float low, float high)
{
    return std::uniform_real_distribution<float>(low, high)(random);
}

int anyInteger(std::mt19937& random, int low, int high)
{
    return std::uniform_int_distribution<int>(low, high)(random);
}

glm::vec3 anyDirection(std::mt19937& random)
{
    glm::vec3 v;
    do
        v = {anyNumber(random, -1, 1), anyNumber(random, -1, 1), anyNumber(random, -1, 1)};
    while (glm::length(v) < 0.2f || glm::length(v) > 1.0f);
    return glm::normalize(v);
}

std::vector<AffineMatrix> jointsAtRest(const AnimationSet& set)
{
    std::vector<AffineMatrix> matrices;
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), matrices);
    return matrices;
}

glm::vec3 originOf(const AffineMatrix& matrix)
{
    return {matrix.rows[0].w, matrix.rows[1].w, matrix.rows[2].w};
}

/// The size of the skeleton at rest.
float sizeOf(const AnimationSet& set)
{
    glm::vec3 low(1e30f), high(-1e30f);
    for (const AffineMatrix& matrix : jointsAtRest(set))
    {
        low = glm::min(low, originOf(matrix));
        high = glm::max(high, originOf(matrix));
    }
    return std::max(glm::length(high - low), 1e-6f);
}

/// A joint and up to `count` - 1 of its ancestors, the highest first, named uniquely.
std::vector<std::string> anyChain(const AnimationSet& set, int count, std::mt19937& random)
{
    const Skeleton& skeleton = set.skeleton();
    std::vector<std::string> names;
    int joint = anyInteger(random, 0, static_cast<int>(skeleton.jointCount()) - 1);
    for (; joint >= 0 && static_cast<int>(names.size()) < count;
         joint = skeleton.joint(static_cast<std::size_t>(joint)).parent)
        if (skeleton.findJoint(skeleton.joint(static_cast<std::size_t>(joint)).name) == joint)
            names.insert(names.begin(), skeleton.joint(static_cast<std::size_t>(joint)).name);
    return names;
}

Constraint randomLookAt(const AnimationSet& set, const std::string& name, std::mt19937& random)
{
    LookAt look{name, anyChain(set, anyInteger(random, 1, 4), random)};
    look.forward = anyDirection(random);
    do
        look.up = anyDirection(random);
    while (glm::length(glm::cross(look.forward, look.up)) < 0.3f);
    // One draw a statement: compilers evaluate operands in different orders.
    const float away = anyInteger(random, 0, 1) == 0 ? 0.0f : 0.02f * sizeOf(set);
    look.offset = anyDirection(random) * away;
    if (anyInteger(random, 0, 1) == 0) look.cone = anyNumber(random, 0.3f, 2.5f);
    for (std::size_t i = 0; i < look.joints.size(); ++i)
        look.shares.push_back(anyNumber(random, 0.1f, 1.0f));
    return look;
}

std::optional<Constraint> randomLimb(const AnimationSet& set, const std::string& name, std::mt19937& random)
{
    const std::vector<std::string> joints = anyChain(set, 3, random);
    if (joints.size() < 3) return std::nullopt;
    const std::vector<AffineMatrix> matrices = jointsAtRest(set);
    const auto place = [&](std::size_t i)
    { return originOf(matrices[static_cast<std::size_t>(set.skeleton().findJoint(joints[i]))]); };
    const float shortest = 0.02f * sizeOf(set);
    if (glm::distance(place(0), place(1)) < shortest || glm::distance(place(1), place(2)) < shortest)
        return std::nullopt;
    TwoBoneIk limb{name, joints[0], joints[1], joints[2]};
    limb.hinge = anyDirection(random);
    if (anyInteger(random, 0, 1) == 0) limb.softReach = anyNumber(random, 0.3f, 1.0f);
    return limb;
}

} // namespace

std::shared_ptr<const AnimationSet> withRandomConstraints(const AnimationSet& set, std::size_t count,
                                                          std::mt19937& random)
{
    std::vector<Constraint> constraints;
    for (int tries = 0; tries < 1000 && constraints.size() < count; ++tries)
    {
        const std::string name = "constraint " + std::to_string(constraints.size());
        if (constraints.size() % 2 == 0)
            constraints.push_back(randomLookAt(set, name, random));
        else if (const std::optional<Constraint> limb = randomLimb(set, name, random))
            constraints.push_back(*limb);
    }
    std::shuffle(constraints.begin(), constraints.end(), random);
    return set.withConstraints(constraints).value();
}

std::vector<ConstraintTarget> randomTargets(const AnimationSet& set, std::mt19937& random)
{
    const std::vector<AffineMatrix> matrices = jointsAtRest(set);
    const float size = sizeOf(set);
    std::vector<ConstraintTarget> targets;
    for (const ConstraintChain& chain : set.constraintChains())
    {
        ConstraintTarget target;
        targets.push_back(target);
        if (anyInteger(random, 0, 4) == 0) continue;
        const auto joint = [&](std::size_t place)
        { return originOf(matrices[static_cast<std::size_t>(chain.joints[place])]); };
        float away = anyNumber(random, 0.3f, 3.0f) * size;
        if (!chain.isLookAt)
        {
            const float upper = glm::distance(joint(0), joint(chain.mid));
            const float lower = glm::distance(joint(chain.mid), joint(chain.joints.size() - 1));
            away =
                std::abs(upper - lower) + anyNumber(random, 0.05f, 0.95f) * (upper + lower - std::abs(upper - lower));
        }
        target.position = joint(0) + anyDirection(random) * away;
        target.weight = anyInteger(random, 0, 1) == 0 ? 1.0f : anyNumber(random, 0.1f, 1.0f);
        if (anyInteger(random, 0, 1) == 0) target.pole = anyDirection(random);
        if (anyInteger(random, 0, 1) == 0) target.twist = anyNumber(random, -3.0f, 3.0f);
        if (!chain.isLookAt && anyInteger(random, 0, 1) == 0)
        {
            const float w = anyNumber(random, -1, 1);
            target.rotation = glm::vec4(Rotation::unit(glm::dvec4(anyDirection(random), w)));
        }
        targets.back() = target;
    }
    return targets;
}

double sensitivityOf(const AnimationSet& set, const PoseInstruction& instruction, std::mt19937& random)
{
    using Matrices = std::vector<AffineMatrix>;
    const float size = sizeOf(set), step = 1e-4f;
    const auto jointsOf = [&](const PoseInstruction& of)
    {
        std::vector<JointTransform> tracks;
        Matrices matrices;
        Pose::mix(set, of, tracks);
        Pose::jointToModel(set, tracks, AffineMatrix(), matrices);
        return matrices;
    };
    // The largest difference of two poses: of places relative to the size, of axes relative to their length.
    const auto apart = [&](const Matrices& a, const Matrices& b)
    {
        float worst = 0.0f;
        for (std::size_t joint = 0; joint < a.size(); ++joint)
            for (std::size_t row = 0; row < 3; ++row)
            {
                const glm::vec4 difference = a[joint].rows[row] - b[joint].rows[row];
                const float length = std::max(glm::length(glm::vec3(a[joint].rows[row])), 1e-9f);
                worst = std::max({worst, std::abs(difference.w) / size, glm::length(glm::vec3(difference)) / length});
            }
        return static_cast<double>(worst);
    };
    PoseInstruction mixed = instruction;
    mixed.targets.clear();
    const Matrices before = jointsOf(instruction), mixedBefore = jointsOf(mixed);
    double worst = 0.0;
    for (int time = 0; time < 4; ++time)
    {
        PoseInstruction moved = instruction;
        for (ConstraintTarget& target : moved.targets)
        {
            target.position += anyDirection(random) * (step * size);
            if (target.pole != glm::vec3(0.0f)) target.pole += anyDirection(random) * step;
        }
        worst = std::max(worst, apart(before, jointsOf(moved)) / static_cast<double>(step));
    }
    for (std::size_t i = 0; i < instruction.sampleCount; ++i)
    {
        PoseInstruction moved = mixed;
        float& alpha = moved.samples[i].alpha;
        alpha += alpha < 0.5f ? 1e-3f : -1e-3f;
        const double moves = apart(mixedBefore, jointsOf(moved));
        moved.targets = instruction.targets;
        if (moves > 1e-5) worst = std::max(worst, apart(before, jointsOf(moved)) / moves);
    }
    return worst;
}

} // namespace osgGpuAnimation
