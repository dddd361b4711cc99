// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DetailRange.h>

#include <osgGpuAnimation/nodes/MeshesOfGroup.h>

#include <algorithm>

namespace osgGpuAnimation
{

DetailRange::DetailRange(const osg::Group& meshes, const AnimationSet& set)
{
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    const std::shared_ptr<const DetailLevels> levels = mesh.detailLevels(set);
                    if (levels->finest() == DetailLevels::allTriangles) return;
                    _finest = std::min(_finest, levels->finest());
                    _coarsest = std::max(_coarsest, levels->coarsest());
                });
}

} // namespace osgGpuAnimation
