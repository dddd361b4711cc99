// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CompactCharacter.h>

#include <osgGpuAnimation/animation/CompactClips.h>
#include <osgGpuAnimation/nodes/EntryReach.h>
#include <osgGpuAnimation/nodes/SkinnedGeometryVisitor.h>

namespace osgGpuAnimation
{

namespace
{

EntryBoxes entryBoxesOf(AnimatedCharacter& character)
{
    EntryReach reach(character.set());
    SkinnedGeometryVisitor collect([&](SkinnedGeometry& mesh) { reach.add(mesh); });
    character.accept(collect);
    return reach.boxes();
}

} // namespace

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    const EntryBoxes boxes = entryBoxesOf(character);
    CompactedCharacter result;
    result.longestSide = longestSide(character.set(), boxes);
    result.tolerance = fraction * result.longestSide;
    Result<CompactedSet> compacted = compactClips(character.set(), boxes, {result.tolerance});
    if (!compacted) return compacted.error();
    const Result<bool> taken = character.setAnimationSet(compacted.value().set);
    if (!taken) return taken.error();
    result.errors = compacted.value().errors;
    return result;
}

} // namespace osgGpuAnimation
