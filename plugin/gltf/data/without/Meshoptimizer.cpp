// SPDX-License-Identifier: MIT
#include "gltf/data/Meshoptimizer.h"

#include "gltf/file/Report.h"

namespace osgGpuAnimation::gltf
{

Result<void> decodeMeshopt(const MeshoptElements&, const unsigned char*, std::size_t, std::vector<unsigned char>&)
{
    return missingLibrary("the view", "meshoptimizer");
}

void optimizeForVertexCache(std::vector<std::uint32_t>&, std::size_t) {}

} // namespace osgGpuAnimation::gltf
