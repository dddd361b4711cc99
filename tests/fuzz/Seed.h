// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// One file of the fuzzers' initial corpus: a document and the data of its first buffer.
struct Seed
{
    std::string name;
    nlohmann::json json;
    std::string binary; ///< of buffers[0]; empty if the buffer has its own URI or does not exist

    std::string glb() const;
    std::string gltf() const; ///< with the data in a data URI
};

/// Small models, one for each supported part of glTF.
std::vector<Seed> modelSeeds();
/// Models compressed by EXT_meshopt_compression and KHR_draco_mesh_compression.
std::vector<Seed> compressedSeeds();

} // namespace osgGpuAnimation::gltf
