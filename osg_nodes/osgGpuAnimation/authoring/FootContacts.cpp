// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/FootContacts.h>

#include <osgGpuAnimation/animation/playback/FootPaths.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, const std::string& clip,
                                                  const std::string& joint)
{
    const Result<std::size_t> foundClip = set.clipNamed(clip);
    if (!foundClip) return foundClip.error();
    const Result<std::size_t> foundJoint = set.skeleton().jointNamed(joint);
    if (!foundJoint) return foundJoint.error();
    return findFootContacts(set, foundClip.value(), foundJoint.value());
}

Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, std::size_t clip, std::size_t joint)
{
    if (const Result<std::size_t> known = set.clipAt(clip); !known) return known.error();
    if (joint >= set.skeleton().jointCount())
        return Error{"there is no joint " + std::to_string(joint) + " among " +
                     std::to_string(set.skeleton().jointCount())};
    const double duration = set.clips()[clip].duration();
    std::vector<FootContact> contacts;
    if (!(duration > 0.0)) return contacts;
    const double samples = std::ceil(std::clamp(duration * 240.0, 64.0, 65536.0));
    std::vector<double> times;
    for (double sample = 0.0; sample <= samples; sample += 1.0)
        times.push_back(duration * sample / samples);
    const auto poseAt = [&](std::size_t sample)
    {
        PoseInstruction instruction;
        instruction.samples[0] = set.sampleAt(static_cast<int>(clip), times[sample]);
        return instruction;
    };
    const FootPaths paths(set, times, poseAt, {joint});
    for (const auto& [first, last] : paths.contactsOf(0))
        contacts.push_back(
            {duration * static_cast<double>(first) / samples, duration * static_cast<double>(last) / samples});
    return contacts;
}

} // namespace osgGpuAnimation
