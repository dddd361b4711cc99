// SPDX-License-Identifier: MIT
#include "gltf/data/DracoMesh.h"

#include "gltf/file/Report.h"

namespace osgGpuAnimation::gltf
{

Result<std::vector<std::uint32_t>> decodeDraco(const unsigned char*, std::size_t, std::size_t, const std::string& name,
                                               std::vector<DracoAttribute>&)
{
    return Error{name + ": " + missingLibrary("the primitive", "Draco").message};
}

} // namespace osgGpuAnimation::gltf
