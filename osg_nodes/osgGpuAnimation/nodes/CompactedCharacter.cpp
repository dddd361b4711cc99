// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CompactedCharacter.h>

#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

namespace osgGpuAnimation
{

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    PaletteEntryBounds bounds(character.getAnimationSet());
    forEachMeshBelow(character, [&](const SkinnedGeometry& mesh) { bounds.add(mesh); });
    const EntryBoxes& boxes = bounds.boxes();
    CompactedCharacter result;
    result.longestSide = longestSide(character.getAnimationSet(), boxes);
    result.tolerance = fraction * result.longestSide;
    Result<CompactedSet> compacted = compactClips(character.getAnimationSet(), boxes, {result.tolerance});
    if (!compacted) return compacted.error();
    const Result<void> taken = character.setAnimationSet(compacted.value().set);
    if (!taken) return taken.error();
    result.errors = compacted.value().errors;
    return result;
}

} // namespace osgGpuAnimation
