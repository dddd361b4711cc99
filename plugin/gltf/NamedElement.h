// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ElementName.h"

namespace osgGpuAnimation::gltf
{

/// An element with the name that the file gives it, for messages to people: `animations[2] "Run"`.
inline std::string namedElement(std::string_view collection, std::size_t index, std::string_view name)
{
    return elementName(collection, index) + (name.empty() ? "" : ' ' + quoted(name));
}

} // namespace osgGpuAnimation::gltf
