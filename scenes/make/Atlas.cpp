// SPDX-License-Identifier: MIT
#include "Atlas.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace osgGpuAnimation::scenes
{

namespace
{

glm::dvec3 shaded(const Part& part, double u, double v)
{
    // Shadows take on the surface's own colour, as light does that is thrown to and fro: plain grey looks like dirt.
    const glm::dvec3 colour = part.painter(part.surfaceAt(u, v));
    const glm::dvec3 shadow = glm::mix(glm::dvec3(0.40, 0.34, 0.40), colour, 0.45);
    return colour * glm::mix(shadow, glm::dvec3(1.0), part.lightAt(u, v));
}

glm::dvec3 texel(const Part& part, int x, int y)
{
    glm::dvec3 sum(0.0);
    for (double dy : {0.25, 0.75})
        for (double dx : {0.25, 0.75})
            sum += shaded(part, std::clamp((x + dx) / part.rect.width, 0.0, 1.0),
                          std::clamp((y + dy) / part.rect.height, 0.0, 1.0));
    return glm::clamp(sum * 0.25, 0.0, 1.0);
}

} // namespace

AtlasRect Atlas::allocate(int width, int height)
{
    if (_x + width + 2 * gutter > size)
    {
        _x = 0;
        _y += _shelf;
        _shelf = 0;
    }
    _shelf = std::max(_shelf, height + 2 * gutter);
    if (_y + _shelf > size) throw std::length_error("the texture atlas is full");
    const AtlasRect rect{_x + gutter, _y + gutter, width, height};
    _x += width + 2 * gutter;
    return rect;
}

void Atlas::paint(const Part& part)
{
    for (int y = -gutter; y < part.rect.height + gutter; ++y)
        for (int x = -gutter; x < part.rect.width + gutter; ++x)
        {
            const glm::dvec3 colour = texel(part, x, y);
            const int offset = ((part.rect.y + y) * size + part.rect.x + x) * 3;
            for (int channel = 0; channel < 3; ++channel)
                _pixels[offset + channel] = static_cast<std::uint8_t>(std::lround(colour[channel] * 255.0));
        }
    const int first = gutter / 2;
    for (int y = part.rect.y / 2 - first; y < (part.rect.y + part.rect.height) / 2 + first; ++y)
        for (int x = part.rect.x / 2 - first; x < (part.rect.x + part.rect.width) / 2 + first; ++x)
        {
            const double u = std::clamp((2.0 * x + 1.0 - part.rect.x) / part.rect.width, 0.0, 1.0);
            const double v = std::clamp((2.0 * y + 1.0 - part.rect.y) / part.rect.height, 0.0, 1.0);
            const glm::dvec3 reflection = glm::clamp(part.reflection(part.surfaceAt(u, v)), 0.0, 1.0);
            for (int channel = 0; channel < 3; ++channel)
                _reflections[(y * reflectionSize + x) * 3 + channel] =
                    static_cast<std::uint8_t>(std::lround(reflection[channel] * 255.0));
        }
}

} // namespace osgGpuAnimation::scenes
