// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <random>
#include <string>

namespace osgGpuAnimation::gltf
{

/// Changes one value of a JSON document and keeps it valid JSON, which random bytes rarely do: replaces a number,
/// removes or duplicates a member, or replaces one member by another. Nothing if the text is not JSON.
std::optional<std::string> mutateDocument(const std::string& text, std::minstd_rand& random);

} // namespace osgGpuAnimation::gltf
