// SPDX-License-Identifier: MIT
#include "gltf/ValidateAnimations.h"

#include "gltf/AddedData.h"
#include "gltf/data/Accessor.h"
#include "gltf/data/AttributeSemantic.h"
#include "gltf/ElementName.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;

bool isFloat(const tinygltf::Accessor& accessor)
{
    return accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

/// Floats, or the normalized small integers that rotations and weights may be of.
bool isFloatOrNormalized(const tinygltf::Accessor& accessor)
{
    return isFloat(accessor) || (accessor.normalized && componentBytes(accessor.componentType) <= 2);
}

std::string in(int accessor)
{
    return " in " + elementName("accessors", std::size_t(accessor));
}

bool isCubic(const tinygltf::AnimationSampler& sampler)
{
    return std::string_view(sampler.interpolation) == "CUBICSPLINE";
}

/// Empty where an output may drive the path, else what is expected.
std::string wrongOutputFormat(const tinygltf::Accessor& output, std::string_view path)
{
    if (path == "rotation")
        return output.type == TINYGLTF_TYPE_VEC4 && isFloatOrNormalized(output)
                   ? ""
                   : "VEC4 of float or normalized byte, unsigned byte, short or unsigned short";
    if (path == "weights")
        return output.type == TINYGLTF_TYPE_SCALAR && isFloatOrNormalized(output)
                   ? ""
                   : "SCALAR of float or normalized byte, unsigned byte, short or unsigned short";
    return output.type == TINYGLTF_TYPE_VEC3 && isFloat(output) ? "" : "VEC3 of float";
}

/// Checks animations one after another and remembers which shared accessors it has seen.
class AnimationValidation
{
public:
    AnimationValidation(Model& model, Report& report) : _model(model), _report(report), _inputs(model.accessors.size())
    {
    }

    std::optional<Error> validate(std::size_t a)
    {
        const tinygltf::Animation& animation = _model.animations[a];
        for (std::size_t s = 0; s < animation.samplers.size(); ++s)
            if (std::optional<Error> error =
                    validateInput(animation.samplers[s].input, elementName("animations", a, "samplers", s) + ".input"))
                return error;
        for (std::size_t c = 0; c < animation.channels.size(); ++c)
            if (animation.channels[c].target_node >= 0)
                if (std::optional<Error> error = validateChannel(a, c)) return error;
        emptyIfFaulty(a);
        return std::nullopt;
    }

private:
    enum class Times
    {
        Unseen,
        Good,
        Negative, ///< the first one
        Twice,    ///< one of them
    };

    const tinygltf::Accessor& accessorOf(int index) const { return _model.accessors[std::size_t(index)]; }

    std::optional<Error> validateInput(int input, const std::string& name)
    {
        const tinygltf::Accessor& accessor = accessorOf(input);
        Times& seen = _inputs[std::size_t(input)];
        if (seen != Times::Unseen) return std::nullopt;
        if (accessor.type != TINYGLTF_TYPE_SCALAR || !isFloat(accessor))
            return fault(name, "SCALAR of float", formatText(accessor) + in(input));
        const std::vector<float> times = readFloats(_model, input);
        seen = times[0] < 0.0f ? Times::Negative : Times::Good;
        for (std::size_t i = 1; i < times.size(); ++i)
        {
            if (times[i] < times[i - 1])
                return fault(name, "times that increase",
                             numberText(times[i]) + " after " + numberText(times[i - 1]) + in(input));
            if (times[i] == times[i - 1]) seen = Times::Twice;
        }
        return std::nullopt;
    }

    /// Takes the channels from an animation that has no clip in it because of its times.
    void emptyIfFaulty(std::size_t a)
    {
        tinygltf::Animation& animation = _model.animations[a];
        for (const tinygltf::AnimationChannel& channel : animation.channels)
        {
            if (channel.target_node < 0) continue;
            const int input = animation.samplers[std::size_t(channel.sampler)].input;
            const Times times = _inputs[std::size_t(input)];
            if (times == Times::Good) continue;
            _report.warn(elementName("animations", a, "samplers", std::size_t(channel.sampler)) + ".input: " +
                         (times == Times::Twice ? "expected times that increase, found " + firstTwice(input) + " twice"
                                                : "the first time is negative") +
                         in(input) + "; clip " + (animation.name.empty() ? "" : quoted(animation.name) + " ") +
                         "skipped");
            animation.channels.clear();
            return;
        }
    }

    std::string firstTwice(int input) const
    {
        const std::vector<float> times = readFloats(_model, input);
        return numberText(*std::adjacent_find(times.begin(), times.end()));
    }

    std::optional<Error> validateChannel(std::size_t a, std::size_t c)
    {
        const tinygltf::AnimationChannel& channel = _model.animations[a].channels[c];
        tinygltf::AnimationSampler& sampler = _model.animations[a].samplers[std::size_t(channel.sampler)];
        const tinygltf::Accessor& output = accessorOf(sampler.output);
        const auto samplerName = [&]
        { return elementName("animations", a, "samplers", std::size_t(channel.sampler)) + ".output"; };
        const auto channelName = [&] { return elementName("animations", a, "channels", c); };

        const std::string wrong = wrongOutputFormat(output, channel.target_path);
        if (!wrong.empty())
            return fault(samplerName(), wrong + " for " + channel.target_path, formatText(output) + in(sampler.output));
        const std::size_t values = valuesOfKey(channel);
        if (values == 0)
            return fault(channelName() + ".target", "a node with morph targets for weights",
                         elementName("nodes", std::size_t(channel.target_node)) + ", which has none");
        const std::size_t perTime = values * (isCubic(sampler) ? 3 : 1);
        const std::size_t times = accessorOf(sampler.input).count;
        if (output.count / perTime != times || output.count % perTime != 0)
            return fault(samplerName(),
                         std::to_string(perTime) + " values for each of " + std::to_string(times) + " times",
                         std::to_string(output.count) + " values" + in(sampler.output));
        warnOfMatrix(channel, channelName);
        if (std::string_view(channel.target_path) == "rotation") mendRotations(sampler, samplerName);
        return std::nullopt;
    }

    /// 1, or the number of morph targets for weights.
    std::size_t valuesOfKey(const tinygltf::AnimationChannel& channel) const
    {
        if (std::string_view(channel.target_path) != "weights") return 1;
        const int mesh = _model.nodes[std::size_t(channel.target_node)].mesh;
        return mesh < 0 ? 0 : _model.meshes[std::size_t(mesh)].primitives.front().targets.size();
    }

    template <typename Name>
    void warnOfMatrix(const tinygltf::AnimationChannel& channel, const Name& name)
    {
        if (!_model.nodes[std::size_t(channel.target_node)].matrix.empty())
            _report.warn(name() + ".target: " + elementName("nodes", std::size_t(channel.target_node)) +
                         " has a matrix, which no animation should change");
    }

    /// A quaternion of length 0 is no rotation: the one before it is held.
    template <typename Name>
    void mendRotations(tinygltf::AnimationSampler& sampler, const Name& name)
    {
        const bool cubic = isCubic(sampler);
        int& seen = _rotations.try_emplace(std::pair(sampler.output, cubic), unseen).first->second;
        if (seen != unseen)
        {
            sampler.output = seen;
            return;
        }
        seen = sampler.output;
        std::vector<float> rotations = readFloats(_model, sampler.output);
        const float* held = identity;
        bool mended = false;
        for (std::size_t i = cubic ? 4 : 0; i < rotations.size(); i += cubic ? 12 : 4)
        {
            float* const q = &rotations[i];
            const double squares =
                double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3];
            if (squares < 1e-12)
            {
                std::copy_n(held, 4, q);
                mended = true;
            }
            held = q;
        }
        if (!mended) return;
        _report.warn(name() + ": expected unit quaternions, found one of length 0; the rotation before it is held" +
                     in(sampler.output));
        sampler.output = seen = addAccessor(_model, rotations, TINYGLTF_TYPE_VEC4);
    }

    static constexpr int unseen = -1;
    static constexpr float identity[4] = {0.0f, 0.0f, 0.0f, 1.0f};

    Model& _model;
    Report& _report;
    std::vector<Times> _inputs; ///< one an accessor of the file
    /// The accessor to take for a rotation output, by the file's accessor and whether it is read as CUBICSPLINE.
    std::map<std::pair<int, bool>, int> _rotations;
};

} // namespace

std::optional<Error> validateAnimations(Model& model, Report& report)
{
    AnimationValidation validation(model, report);
    for (std::size_t a = 0; a < model.animations.size(); ++a)
        if (std::optional<Error> error = validation.validate(a)) return error;
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
