// SPDX-License-Identifier: MIT
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <layout.glsl>

#include <algorithm>

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

} // namespace osgGpuAnimation
