// SPDX-License-Identifier: MIT
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

class Maker
{
public:
    explicit Maker(const RandomSetShape& shape) : _shape(shape), _random(shape.seed) {}

    std::shared_ptr<const AnimationSet> make()
    {
        AnimationParts parts{Skeleton::create(joints()).value(), {}, {}, {}, {}};
        parts.skins.push_back(skin(parts.skeleton));
        if (_shape.secondSkin) parts.skins.push_back(skin(parts.skeleton));
        for (int i = 0; i < 4; ++i)
            parts.rigidJoints.push_back(whole(0, _shape.joints - 1));
        if (_shape.weights) parts.morphs = {{"mouth", -1, numbers(5, 0, 1)}, {"face", -1, numbers(30, 0, 1)}};
        for (int i = 0; i < 3; ++i)
            parts.clips.push_back(clip(parts.skeleton, parts.morphs, _shape.splines && i < 2));
        return AnimationSet::create(std::move(parts)).value();
    }

private:
    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(_random); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(_random); }

    std::vector<float> numbers(std::size_t count, double low, double high)
    {
        std::vector<float> out(count);
        for (float& value : out)
            value = static_cast<float>(number(low, high));
        return out;
    }

    glm::vec4 rotation()
    {
        const glm::dvec4 q(number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1));
        return glm::vec4(q / std::sqrt(glm::dot(q, q) + 1e-9));
    }

    JointTransform transform()
    {
        return {glm::vec4(number(-1, 1), number(-1, 1), number(-1, 1), 0), rotation(),
                glm::vec4(number(0.7, 1.3), number(0.7, 1.3), number(0.7, 1.3), 0)};
    }

    std::vector<Joint> joints()
    {
        std::vector<Joint> out;
        for (int i = 0; i < _shape.joints; ++i)
        {
            const bool isChain = i > 0 && i < _shape.depth;
            const int parent = isChain ? i - 1 : whole(-1, std::min(i, _shape.depth) - 1);
            out.push_back({"joint" + std::to_string(i), i == 0 ? -1 : parent, transform(), i});
        }
        return out;
    }

    Skin skin(const Skeleton& skeleton)
    {
        Skin out;
        for (std::size_t joint = 0; joint < skeleton.jointCount(); joint += static_cast<std::size_t>(whole(1, 2)))
        {
            out.joints.push_back(static_cast<int>(joint));
            out.inverseBinds.push_back(transform().toMatrix());
        }
        return out;
    }

    Channel channel(Channel::Path path, int target, std::size_t width, bool spline)
    {
        Channel out;
        out.path = path;
        out.target = target;
        const int choice = whole(0, spline ? 2 : 1);
        out.interpolation = choice == 0   ? Channel::Interpolation::Step
                            : choice == 1 ? Channel::Interpolation::Linear
                                          : Channel::Interpolation::CubicSpline;
        double time = number(0, 0.5);
        for (int key = 0; key < _shape.keys; ++key, time += number(0.05, 0.7))
            out.times.push_back(static_cast<float>(time));
        const bool isRotation = path == Channel::Path::Rotation;
        const std::size_t valuesPerKey = choice == 2 ? 3 : 1;
        for (std::size_t value = 0; value < out.times.size() * valuesPerKey; ++value)
        {
            const bool isTangent = choice == 2 && value % 3 != 1;
            const glm::vec4 q = rotation();
            for (std::size_t i = 0; i < width; ++i)
                out.values.push_back(static_cast<float>(isRotation && !isTangent ? q[static_cast<int>(i)]
                                                        : path == Channel::Path::Scale && !isTangent ? number(0.7, 1.3)
                                                                                                     : number(-1, 1)));
        }
        return out;
    }

    Clip clip(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs, bool spline)
    {
        ClipBuilder builder(skeleton, morphs);
        const auto add = [&](Channel channel) { (void)builder.add(std::move(channel)); };
        for (int joint = 0; joint < static_cast<int>(skeleton.jointCount()); ++joint)
        {
            if (whole(0, 3) != 0) add(channel(Channel::Path::Rotation, joint, 4, spline));
            if (whole(0, 3) == 0) add(channel(Channel::Path::Translation, joint, 3, spline));
            if (whole(0, 3) == 0) add(channel(Channel::Path::Scale, joint, 3, spline));
        }
        for (std::size_t morph = 0; morph < morphs.size(); ++morph)
            add(channel(Channel::Path::Weights, static_cast<int>(morph), morphs[morph].defaults.size(), spline));
        return builder.build("clip");
    }

    RandomSetShape _shape;
    std::mt19937 _random;
};

double number(std::mt19937& random, double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(random);
}

int whole(std::mt19937& random, int low, int high)
{
    return std::uniform_int_distribution<int>(low, high)(random);
}

BlendSample randomSample(const AnimationSet& set, std::mt19937& random)
{
    const int clip = whole(random, 0, static_cast<int>(set.clips().size()) - 1);
    const double time = number(random, -0.1, 1.1) * set.clips()[static_cast<std::size_t>(clip)].duration();
    return instructionAt(set, clip, time).samples[0];
}

float anyNumber(std::mt19937& random, float low, float high)
{
    return std::uniform_real_distribution<float>(low, high)(random);
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
    int joint = whole(random, 0, static_cast<int>(skeleton.jointCount()) - 1);
    for (; joint >= 0 && static_cast<int>(names.size()) < count;
         joint = skeleton.joint(static_cast<std::size_t>(joint)).parent)
        if (skeleton.findJoint(skeleton.joint(static_cast<std::size_t>(joint)).name) == joint)
            names.insert(names.begin(), skeleton.joint(static_cast<std::size_t>(joint)).name);
    return names;
}

Constraint randomLookAt(const AnimationSet& set, const std::string& name, std::mt19937& random)
{
    LookAt look{name, anyChain(set, whole(random, 1, 4), random)};
    look.forward = anyDirection(random);
    do
        look.up = anyDirection(random);
    while (glm::length(glm::cross(look.forward, look.up)) < 0.3f);
    // One draw a statement: compilers evaluate operands in different orders.
    const float away = whole(random, 0, 1) == 0 ? 0.0f : 0.02f * sizeOf(set);
    look.offset = anyDirection(random) * away;
    if (whole(random, 0, 1) == 0) look.cone = anyNumber(random, 0.3f, 2.5f);
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
    if (whole(random, 0, 1) == 0) limb.softReach = anyNumber(random, 0.3f, 1.0f);
    return limb;
}

} // namespace

std::shared_ptr<const AnimationSet> makeRandomSet(const RandomSetShape& shape)
{
    return Maker(shape).make();
}

PoseInstruction instructionAt(const AnimationSet& set, int clip, double time)
{
    PoseInstruction instruction;
    if (clip < 0) return instruction;
    const Clip& content = set.clips()[static_cast<std::size_t>(clip)];
    const Clip::Span span = content.locate(time);
    instruction.samples[0] = {
        static_cast<std::uint32_t>(set.firstKeyframe(static_cast<std::size_t>(clip)) + span.keyframe), span.alpha, 1.0f,
        content.form() == Clip::Form::Spline ? POSE_SAMPLE_SPLINE : 0u};
    return instruction;
}

std::size_t maskCount(const AnimationSet& set)
{
    std::size_t count = 0;
    for (std::uint32_t number = 1; number <= MaskTable::maxMasks; ++number)
        count += set.masks().find(number) != nullptr;
    return count;
}

void addRandomMasks(const AnimationSet& set, std::mt19937& random)
{
    static std::vector<std::shared_ptr<const SetMask>> kept;
    const auto joints = static_cast<int>(set.skeleton().jointCount());
    for (int i = 0; i < 4; ++i)
    {
        const auto joint = static_cast<std::size_t>(whole(random, 0, joints - 1));
        const Result<JointMask> tree = JointMask::subtree(set, set.skeleton().joint(joint).name, whole(random, 0, 3));
        if (tree) kept.push_back(set.useMask(tree.value().weights()).value());
        JointMask mask(set);
        for (std::size_t j = 0; j < set.skeleton().jointCount(); ++j)
            mask.setJoint(j, static_cast<float>(number(random, -0.3, 1.3)));
        for (std::size_t m = 0; m < set.morphs().size(); ++m)
            mask.setMorph(m, static_cast<float>(number(random, 0.0, 1.0)));
        kept.push_back(set.useMask(mask.weights()).value());
    }
}

std::shared_ptr<const JointPose> randomPose(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random)
{
    const auto pose = std::make_shared<JointPose>(set);
    const auto any = [&] { return static_cast<float>(number(random, -1.0, 1.0)); };
    for (std::size_t joint = 0; joint < set->skeleton().jointCount(); ++joint)
    {
        const int parts = whole(random, 0, 11); // three of four joints have something
        if ((parts & 1) != 0) pose->setTranslation(joint, {any(), any(), any()});
        if ((parts & 2) != 0) pose->setRotation(joint, glm::quat(any(), any(), any(), any()));
        if ((parts & 4) != 0) pose->setScale(joint, glm::vec3(1.0f) + 0.3f * glm::vec3(any(), any(), any()));
    }
    for (std::size_t morph = 0; morph < set->morphs().size(); ++morph)
        for (std::size_t target = 0; target < set->morphs()[morph].defaults.size(); ++target)
            if (whole(random, 0, 1) == 0) pose->setMorphWeight(morph, target, 2.0f * any());
    return pose;
}

void addRandomPoses(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random, PoseInstruction& instruction)
{
    for (std::size_t i = 0; i < instruction.sampleCount; ++i)
    {
        BlendSample& sample = instruction.samples[i];
        if ((sample.control & POSE_SAMPLE_REFERENCE) != 0 || whole(random, 0, 2) != 0) continue;
        sample.control = (sample.control & ~POSE_SAMPLE_SPLINE) | POSE_SAMPLE_POSED;
        sample.keyframe = static_cast<std::uint32_t>(instruction.poses.size());
        sample.alpha = 0.0f;
        instruction.poses.push_back(randomPose(set, random));
    }
}

PoseInstruction randomLayers(const AnimationSet& set, std::mt19937& random)
{
    PoseInstruction out;
    out.sampleCount = 0;
    const auto randomMask = [&]
    {
        const int mask = whole(random, 0, 1) == 0 ? 0 : whole(random, 0, static_cast<int>(maskCount(set)));
        return static_cast<std::uint32_t>(mask) << POSE_SAMPLE_MASK_SHIFT;
    };
    const int priorityCount = whole(random, 0, 3);
    for (int priority = 0; priority < priorityCount; ++priority)
        for (int count = whole(random, 1, 4), i = 0; i < count; ++i)
        {
            BlendSample& sample = out.samples[out.sampleCount++] = randomSample(set, random);
            sample.weight = whole(random, 0, 3) == 0 ? 1.0f : static_cast<float>(number(random, 0.0, 0.8));
            sample.control |= randomMask() | (i == 0 && priority > 0 ? POSE_SAMPLE_ABOVE : 0u);
        }
    for (int count = whole(random, 0, 2); count > 0; --count)
    {
        BlendSample& reference = out.samples[out.sampleCount++] =
            whole(random, 0, 1) == 0 ? BlendSample() : randomSample(set, random);
        BlendSample& sample = out.samples[out.sampleCount++] = randomSample(set, random);
        const std::uint32_t mask = randomMask();
        reference.weight = sample.weight = static_cast<float>(number(random, 0.0, 1.0));
        reference.control |= POSE_SAMPLE_REFERENCE | mask;
        sample.control |= POSE_SAMPLE_ADDITIVE | mask;
    }
    if (out.sampleCount == 0) out.sampleCount = 1;
    return out;
}

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
        if (whole(random, 0, 4) == 0) continue;
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
        target.weight = whole(random, 0, 1) == 0 ? 1.0f : anyNumber(random, 0.1f, 1.0f);
        if (whole(random, 0, 1) == 0) target.pole = anyDirection(random);
        if (whole(random, 0, 1) == 0) target.twist = anyNumber(random, -3.0f, 3.0f);
        if (!chain.isLookAt && whole(random, 0, 1) == 0)
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
