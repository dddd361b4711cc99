// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GeometryWriter.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Finds what of a character lies too far out for the import, see TransformBound::maxNumber.
class CharacterReach
{
public:
    /// above: from the axes of the set's file to the scene.
    CharacterReach(std::shared_ptr<const AnimationSet> set, const TransformBound& above);

    /// False: the joints at rest or the inverse bind matrices are too large, so that nothing of it can be written.
    bool fits() const { return _fits; }
    /// The set with the clips that fit.
    const std::shared_ptr<const AnimationSet>& set() const { return _set; }
    const std::vector<std::string>& clipsLeftOut() const { return _clipsLeftOut; } ///< names
    /// False: the mesh's vertices lie too far out in some pose of the set.
    bool reaches(const SkinnedGeometry& mesh, GeometryWriter& geometries) const;

private:
    std::shared_ptr<const AnimationSet> _set;
    TransformBound _above;
    TransformBound _entries{0.0, 0.0}; ///< of all palette entries to the scene
    std::vector<std::string> _clipsLeftOut;
    bool _fits = true;
};

} // namespace osgGpuAnimation::gltf
