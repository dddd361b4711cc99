// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CompactCharacter.h>

#include <osgGpuAnimation/animation/CompactClips.h>
#include <osgGpuAnimation/nodes/SkinnedGeometryVisitor.h>

namespace osgGpuAnimation
{

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    EntryBoxes boxes(character.set().paletteSize());
    SkinnedGeometry::BindBoxes bindBoxes;
    SkinnedGeometryVisitor collect([&](SkinnedGeometry& mesh)
                                   { mesh.addToEntryBoxes(character.set(), boxes, bindBoxes); });
    character.accept(collect);
    CompactedCharacter result;
    result.modelSize = modelSize(character.set(), boxes);
    result.tolerance = fraction * result.modelSize;
    Result<CompactedSet> compacted = compactClips(character.set(), boxes, {result.tolerance});
    if (!compacted) return compacted.error();
    const Result<bool> taken = character.setAnimationSet(compacted.value().set);
    if (!taken) return taken.error();
    result.errors = compacted.value().errors;
    return result;
}

} // namespace osgGpuAnimation
