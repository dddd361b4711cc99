// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::gltf
{

/// Imports one input up to the finished OSG graph and its bounds, within limits that keep a fuzzer fast. fileName: the
/// assumed location of the input; empty: no external files.
void importOnce(const std::string& bytes, const std::string& fileName);

} // namespace osgGpuAnimation::gltf
