// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/PackedTriple.h>

#include <osgGpuAnimation/animation/Rotation.h>

#include <layout.glsl>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace osgGpuAnimation
{

PackedTriple PackedTriple::of(const glm::uvec3& numbers, std::uint32_t place)
{
    assert(numbers.x <= largest && numbers.y <= largest && numbers.z <= largest && place < 4 &&
           "20 bits a number, 2 for the place");
    return {numbers.x | numbers.y << 20, numbers.y >> 12 | numbers.z << 8 | place << 28};
}

glm::uvec3 PackedTriple::numbers() const
{
    return {low & largest, low >> 20 | (high & 0xFFu) << 12, high >> 8 & largest};
}

PackedTriple PackedTriple::ofRotation(const glm::vec4& q)
{
    const glm::dvec4 unit = Rotation::unit(glm::dvec4(q));
    int place = 0;
    for (int i = 1; i < 4; ++i)
        if (std::abs(unit[i]) > std::abs(unit[place])) place = i;
    glm::uvec3 numbers;
    int next = 0;
    for (int i = 0; i < 4; ++i)
    {
        if (i == place) continue;
        const double component = unit[place] < 0.0 ? -unit[i] : unit[i];
        const double number =
            static_cast<double>(POSE_ROTATION_ZERO) + std::round(component / static_cast<double>(POSE_ROTATION_STEP));
        numbers[next++] = static_cast<std::uint32_t>(std::clamp(number, 0.0, static_cast<double>(largest)));
    }
    return of(numbers, static_cast<std::uint32_t>(place));
}

glm::vec4 PackedTriple::rotation() const
{
    const glm::vec3 v = (glm::vec3(numbers()) - POSE_ROTATION_ZERO) * POSE_ROTATION_STEP;
    const float rest = std::sqrt(std::max(1.0f - (v.x * v.x + v.y * v.y + v.z * v.z), 0.0f));
    switch (place())
    {
    case 0:
        return {rest, v.x, v.y, v.z};
    case 1:
        return {v.x, rest, v.y, v.z};
    case 2:
        return {v.x, v.y, rest, v.z};
    default:
        return {v.x, v.y, v.z, rest};
    }
}

} // namespace osgGpuAnimation
