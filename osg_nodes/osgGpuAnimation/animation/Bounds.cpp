// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Bounds.h>

#include <osgGpuAnimation/animation/ClipSweep.h>

#include <cassert>

namespace osgGpuAnimation
{

Box boundsOfClip(const AnimationSet& set, int clip, const EntryBoxes& entryBoxes)
{
    assert(entryBoxes.size() == set.paletteSize() && "a box a palette entry");
    ClipSweep sweep(set, entryBoxes);
    if (clip < 0 || static_cast<std::size_t>(clip) >= set.clips().size()) return sweep.restPose();
    return sweep.clip(set.clips()[static_cast<std::size_t>(clip)]);
}

std::vector<Box> boundsOfClips(const AnimationSet& set, const EntryBoxes& entryBoxes)
{
    std::vector<Box> bounds;
    for (int clip = -1; clip < static_cast<int>(set.clips().size()); ++clip)
        bounds.push_back(boundsOfClip(set, clip, entryBoxes));
    return bounds;
}

} // namespace osgGpuAnimation
