// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CompactedCharacter.h>

#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

namespace osgGpuAnimation
{

namespace
{

EntryBoxes entryBoxesOf(osg::Node& node, const AnimationSet& set)
{
    PaletteEntryBounds bounds(set);
    forEachMeshBelow(node, [&](const SkinnedGeometry& mesh) { bounds.add(mesh); });
    return bounds.boxes();
}

} // namespace

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    const EntryBoxes boxes = entryBoxesOf(character, character.getAnimationSet());
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
