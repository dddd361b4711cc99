// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/CompactClips.h>

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/authoring/keyframes/ClipCompactor.h>

#include <cmath>

namespace osgGpuAnimation
{

Result<CompactedSet> compactClips(const AnimationSet& set, const EntryBoxes& entryBoxes, const CompactOptions& options)
{
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance))
        return Error{"a tolerance of " + std::to_string(options.tolerance) +
                     " for compact clips: expected a finite number above 0"};
    if (entryBoxes.size() != set.paletteSize())
        return Error{std::to_string(entryBoxes.size()) + " boxes for " + std::to_string(set.paletteSize()) +
                     " palette entries"};
    CompactedSet result;
    std::vector<Clip> clips;
    ClipCompactor compactor(set, entryBoxes, longestSide(set, entryBoxes), options.tolerance);
    for (const Clip& clip : set.clips())
    {
        clips.push_back(compactor.compact(clip));
        result.errors.push_back(compactor.error());
    }
    auto made = set.withClips(std::move(clips));
    if (!made) return made.error();
    result.set = std::move(made).value();
    return result;
}

double longestSide(const AnimationSet& set, const EntryBoxes& entryBoxes)
{
    Box box = boundsOfClip(set, -1, entryBoxes);
    if (box.empty()) box = boundsOfJoints(set);
    if (box.empty()) return 0.0;
    return largestComponent(glm::dvec3(box.max - box.min));
}

} // namespace osgGpuAnimation
