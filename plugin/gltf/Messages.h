// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// What an import has to say besides its result: warnings (something of the file was left out or mended) and notes.
/// Each names its element: `animations[2].channels[4]: 10 times but 9 values; channel skipped`.
struct Messages
{
    std::vector<std::string> warnings;
    std::vector<std::string> notes; ///< not a fault of the file: an unknown extension in extensionsUsed, say
};

} // namespace osgGpuAnimation::gltf
