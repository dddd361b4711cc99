// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CompactCharacter.h>

#include <osgGpuAnimation/animation/CompactClips.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

namespace osgGpuAnimation
{

namespace
{

/// The boxes of what each palette entry moves, of all meshes below a node.
class BoxCollector : public osg::NodeVisitor
{
public:
    explicit BoxCollector(const AnimationSet& set)
        : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN), boxes(set.paletteSize()), _set(set)
    {
    }
    void apply(osg::Drawable& drawable) override
    {
        if (auto* mesh = dynamic_cast<SkinnedGeometry*>(&drawable)) mesh->addToEntryBoxes(_set, boxes, _bindBoxes);
    }

    EntryBoxes boxes;

private:
    const AnimationSet& _set;
    SkinnedGeometry::BindBoxes _bindBoxes;
};

} // namespace

Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction)
{
    BoxCollector collector(character.set());
    character.accept(collector);
    CompactedCharacter result;
    result.modelSize = modelSize(character.set(), collector.boxes);
    result.tolerance = fraction * result.modelSize;
    Result<CompactedSet> compacted = compactClips(character.set(), collector.boxes, {result.tolerance});
    if (!compacted) return compacted.error();
    const Result<bool> taken = character.setAnimationSet(compacted.value().set);
    if (!taken) return taken.error();
    result.errors = compacted.value().errors;
    return result;
}

} // namespace osgGpuAnimation
