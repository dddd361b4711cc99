// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <random>
#include <string>

namespace osgGpuAnimation::gltf
{

/// Changes one value of a JSON document and keeps it JSON, which random bytes hardly ever do: a number becomes another
/// one, a member disappears, is doubled or takes the place of another. Nothing where the text is no JSON to begin with.
std::optional<std::string> mutateDocument(const std::string& text, std::minstd_rand& random);

} // namespace osgGpuAnimation::gltf
