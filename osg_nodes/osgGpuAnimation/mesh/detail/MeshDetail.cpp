// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>

namespace osgGpuAnimation
{

std::shared_ptr<const LodLevels> MeshDetail::levels(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    return mesh._lod->of(mesh, set,
                         [&](const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& out)
                         { mesh.computePositions(palette, out); });
}

} // namespace osgGpuAnimation
