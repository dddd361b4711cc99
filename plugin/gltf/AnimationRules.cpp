// SPDX-License-Identifier: MIT
#include "gltf/AnimationRules.h"

#include "gltf/ElementName.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::string_view paths[] = {"translation", "rotation", "scale", "weights"};

/// A number for each property of each node.
using Properties = std::unordered_set<std::uint64_t>;

void ignore(const JsonValue& channel, const JsonValue& target)
{
    target.dropFrom(channel);
}

void checkTarget(const JsonValue& channel, std::size_t animation, std::size_t index, Properties& animated,
                 Report& report)
{
    const JsonValue target = channel["target"];
    if (!target) return;
    const JsonValue node = target["node"], path = target["path"];
    if (!node || !path) return ignore(channel, target); // allowed: an extension may say what is meant
    const auto known = std::find(std::begin(paths), std::end(paths), path.text());
    const auto name = [&] { return elementName("animations", animation, "channels", index) + ".target"; };
    if (known == std::end(paths))
    {
        report.warn(name() + ".path: expected translation, rotation, scale or weights, found " + path.description() +
                    "; channel ignored");
        return ignore(channel, target);
    }
    const std::uint64_t property = std::uint64_t(node.number()) * std::size(paths) + std::uint64_t(known - paths);
    if (animated.insert(property).second) return;
    report.warn(name() + ": another channel animates " + std::string(path.text()) + " of the node; channel ignored");
    ignore(channel, target);
}

} // namespace

std::optional<Error> checkAnimationRules(const JsonValue& animations, Report& report)
{
    std::size_t i = 0;
    for (const JsonValue& animation : animations)
    {
        const std::size_t samplers = animation["samplers"].size();
        Properties animated;
        std::size_t c = 0;
        for (const JsonValue& channel : animation["channels"])
        {
            const JsonValue sampler = channel["sampler"];
            if (sampler.number() >= double(samplers))
                return fault(elementName("animations", i, "channels", c) + ".sampler",
                             "an index below " + std::to_string(samplers) + " of the animation's samplers",
                             sampler.description());
            checkTarget(channel, i, c, animated, report);
            ++c;
        }
        ++i;
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
