// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// One file of the corpus that the fuzzers begin with: a document whose first buffer's data lie beside it.
struct Seed
{
    std::string name;
    nlohmann::json json;
    std::string binary; ///< of buffers[0]; empty where that has a URI of its own, or where there is none

    std::string glb() const;
    std::string gltf() const; ///< the data in a data URI
};

/// Small models of our own, one for each part of glTF that is supported.
std::vector<Seed> modelSeeds();
/// Models compressed by EXT_meshopt_compression and KHR_draco_mesh_compression.
std::vector<Seed> compressedSeeds();

} // namespace osgGpuAnimation::gltf
