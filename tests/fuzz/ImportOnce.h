// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::gltf
{

/// The whole import of one input, up to the finished OSG graph and its bounds, within limits that keep a fuzzer fast.
/// fileName: where the input is said to come from; empty: no external files.
void importOnce(const std::string& bytes, const std::string& fileName);

} // namespace osgGpuAnimation::gltf
