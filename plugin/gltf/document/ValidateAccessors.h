// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/MemoryBudget.h"

#include <osgGpuAnimation/math/Result.h>

#include <tiny_gltf.h>

#include <cstddef>
#include <optional>

namespace osgGpuAnimation::gltf
{

/// Every buffer view lies within its buffer, every accessor within its view, aligned, sparse parts included; sparse
/// indices increase and lie within the accessor; no float is NaN or infinite (glTF 2.0, section 3.6). Accessors without
/// data hold zeros, whose number the data of the document limits.
/// first: the accessor to begin with; those before it are valid.
/// Returns the first fault, for which the document must be refused.
std::optional<Error> validateAccessors(const tinygltf::Model& model, std::size_t first, MemoryBudget& budget);

} // namespace osgGpuAnimation::gltf
