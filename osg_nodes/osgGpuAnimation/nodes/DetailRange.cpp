// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DetailRange.h>

#include <osgGpuAnimation/nodes/MeshesOfGroup.h>

#include <algorithm>

namespace osgGpuAnimation
{

std::string DetailRange::pixelErrorsTaken()
{
    return "a number of pixels from 0 to " + std::to_string(largestPixelError);
}

Result<bool> DetailRange::prepare(float pixels, const osg::Group& meshes, const AnimationSet& set)
{
    if (!isPixelError(pixels))
        return Error{"a pixel error of " + std::to_string(pixels) + ": it must be " + pixelErrorsTaken()};
    if (pixels > 0.0f && set.paletteSize() > 0) static_cast<void>(DetailRange(meshes, set));
    return true;
}

DetailRange::DetailRange(const osg::Group& meshes, const AnimationSet& set)
{
    std::size_t vertices = 0;
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    vertices += mesh.vertexCount();
                    if (vertices > mostVertices) return;
                    const std::shared_ptr<const DetailLevels> levels = mesh.detailLevels(set);
                    if (levels->finest() == DetailLevels::allTriangles) return;
                    _finest = std::min(_finest, levels->finest());
                    _coarsest = std::max(_coarsest, levels->coarsest());
                });
}

} // namespace osgGpuAnimation
