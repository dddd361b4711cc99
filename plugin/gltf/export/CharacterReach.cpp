// SPDX-License-Identifier: MIT
#include "gltf/export/CharacterReach.h"

#include "gltf/export/NodeWriter.h"

#include <osgGpuAnimation/animation/bounds/JointRange.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation::gltf
{

CharacterReach::CharacterReach(std::shared_ptr<const AnimationSet> set, const TransformBound& above)
    : _set(std::move(set)), _above(above)
{
    const auto areNear = [&](const std::vector<TransformBound>& bounds)
    {
        return std::all_of(bounds.begin(), bounds.end(),
                           [&](const TransformBound& bound) { return isNear(above * bound, 0.0); });
    };
    std::vector<TransformBound> inverseBinds;
    for (const PaletteEntry& entry : _set->palette())
        inverseBinds.push_back(TransformBound::of(entry.inverseBind.toColumns()));
    _fits =
        areNear(boundsAtRest(_set->skeleton())) &&
        std::all_of(inverseBinds.begin(), inverseBinds.end(), [](const TransformBound& bound) { return bound.fits(); });
    if (!_fits) return;
    std::vector<Clip> clips;
    for (const Clip& clip : _set->clips())
        if (osgGpuAnimation::fits(_set->skeleton(), clip) && areNear(boundsOfClip(_set->skeleton(), clip)))
            clips.push_back(clip);
        else
            _clipsLeftOut.push_back(clip.name());
    if (!_clipsLeftOut.empty())
        if (auto made = _set->withClips(std::move(clips))) _set = made.value();
    for (const TransformBound& bound : boundsOfEntries(*_set))
        _entries.add(above * bound);
}

bool CharacterReach::reaches(const SkinnedGeometry& mesh, GeometryWriter& geometries) const
{
    double radius = geometries.radiusOf(mesh);
    if (const int morph = mesh.getMorph(); morph >= 0 && static_cast<std::size_t>(morph) < _set->morphs().size())
    {
        const std::vector<WeightRange> weights = weightRanges(*_set, static_cast<std::size_t>(morph));
        const std::vector<MorphTarget>& targets = mesh.getMorphTargets();
        for (std::size_t target = 0; target < std::min(weights.size(), targets.size()); ++target)
        {
            double moved = 0.0;
            if (targets[target].positions)
                for (const osg::Vec3& delta : *targets[target].positions)
                    moved = std::max(moved, osg::Vec3d(delta).length()); // NaN is written as 0
            radius += moved * std::max(std::abs(static_cast<double>(weights[target].min)),
                                       std::abs(static_cast<double>(weights[target].max)));
        }
    }
    return isNear(_above, radius) && isNear(_entries, radius);
}

} // namespace osgGpuAnimation::gltf
