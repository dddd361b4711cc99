// SPDX-License-Identifier: MIT
#pragma once

#include "AtlasRect.h"
#include "Part.h"

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// The one square texture of a character: every part has a rectangle of it and paints there.
class Atlas
{
public:
    static constexpr int size = 1024;
    static constexpr int reflectionSize = size / 2;
    static constexpr int gutter = 6; ///< texels painted on around a rectangle, so that filtering meets no stranger

    /// Rectangles fill shelves from left to right: ask for the tall ones first. Throws std::length_error when full.
    AtlasRect allocate(int width, int height);
    /// The part's painter under the part's light, with four samples a texel.
    void paint(const Part& part);

    const std::vector<std::uint8_t>& pixels() const { return _pixels; } ///< size x size RGB, upper row first
    /// The metallic-roughness map, of half the size: green is the roughness, blue the metallic share.
    const std::vector<std::uint8_t>& reflections() const { return _reflections; }

private:
    int _x = 0;
    int _y = 0;
    int _shelf = 0;
    std::vector<std::uint8_t> _pixels = std::vector<std::uint8_t>(size * size * 3, 96);
    std::vector<std::uint8_t> _reflections = std::vector<std::uint8_t>(reflectionSize * reflectionSize * 3, 255);
};

} // namespace osgGpuAnimation::scenes
