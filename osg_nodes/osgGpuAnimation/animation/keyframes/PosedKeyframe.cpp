// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>

#include <osgGpuAnimation/math/Rotation.h>

#include <layout.glsl>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstring>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

using Texels = std::vector<glm::uvec4>;

static_assert(sizeof(JointTransform) == 3 * sizeof(glm::uvec4), "a transform is three texels");

std::uint64_t nextSerial()
{
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

/// 1 for each word that is set, else 0.
glm::dvec4 coverOf(const glm::uvec4& words)
{
    glm::dvec4 cover(0.0);
    for (int i = 0; i < 4; ++i)
        cover[i] = words[i] == POSE_NOT_SET ? 0.0 : 1.0;
    return cover;
}

/// Writes an allowed transform with a unit rotation to three texels.
void put(const JointTransform& transform, glm::uvec4* texels)
{
    std::memcpy(texels, &transform, sizeof(transform));
    if (PosedNumbers::isStoredAsItIs(transform)) return;
    texels[PosedKeyframe::Translation].w = texels[PosedKeyframe::Scale].w = 0;
    const float squared = glm::dot(transform.rotation, transform.rotation);
    const glm::vec4 unit = squared > 1e-20f && squared < 1e20f ? transform.rotation / std::sqrt(squared)
                                                               : *PosedNumbers::unitRotation(transform.rotation);
    std::memcpy(&texels[PosedKeyframe::Rotation], &unit, sizeof(unit));
}

} // namespace

PosedKeyframe::PosedKeyframe(std::size_t trackCount)
    : _texels(3 * trackCount, glm::uvec4(POSE_NOT_SET)), _serial(nextSerial())
{
}

PosedKeyframe::PosedKeyframe(const std::vector<JointTransform>& transforms, bool areStoredAsTheyAre)
    : _texels(3 * transforms.size()), _serial(nextSerial()), _isEmpty(transforms.empty())
{
    if (areStoredAsTheyAre && !transforms.empty())
        std::memcpy(_texels.data(), transforms.data(), transforms.size() * sizeof(JointTransform));
    else
        setTransforms(transforms);
}

std::uint32_t PosedKeyframe::setNumbers(std::size_t track) const
{
    std::uint32_t bits = 0;
    for (std::size_t number = 0; number < 12; ++number)
    {
        const glm::uvec4& words = _texels[3 * track + number / 4];
        if (words[static_cast<int>(number % 4)] != POSE_NOT_SET) bits |= 1u << number;
    }
    return bits;
}

JointTransform PosedKeyframe::values(std::size_t track) const
{
    const auto part = [&](std::size_t number)
    {
        const glm::uvec4 words = _texels[3 * track + number] * glm::uvec4(coverOf(_texels[3 * track + number]));
        glm::vec4 values;
        std::memcpy(&values, &words, sizeof(values));
        return values;
    };
    return {part(Translation), part(Rotation), part(Scale)};
}

MixedTrack PosedKeyframe::sample(std::size_t track, MixedTrack& outCover) const
{
    outCover = {coverOf(_texels[3 * track]), coverOf(_texels[3 * track + 1]), coverOf(_texels[3 * track + 2])};
    const JointTransform value = values(track);
    return {glm::dvec4(value.translation), glm::dvec4(value.rotation), glm::dvec4(value.scale)};
}

void PosedKeyframe::setPart(std::size_t joint, Part part, const glm::vec4& value)
{
    std::memcpy(&_texels[3 * joint + part], &value, sizeof(value));
    _isEmpty = false;
    _serial = nextSerial();
}

void PosedKeyframe::setTransform(std::size_t joint, const JointTransform& transform)
{
    put(transform, &_texels[3 * joint]);
    _isEmpty = false;
    _serial = nextSerial();
}

void PosedKeyframe::setTransforms(const std::vector<JointTransform>& transforms)
{
    assert(transforms.size() <= trackCount() && "one transform a track");
    for (std::size_t joint = 0; joint < transforms.size(); ++joint)
        put(transforms[joint], &_texels[3 * joint]);
    _isEmpty = _isEmpty && transforms.empty();
    _serial = nextSerial();
}

void PosedKeyframe::setNumber(std::size_t track, std::size_t number, float value)
{
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    _texels[3 * track + number / 4][static_cast<int>(number % 4)] = bits;
    _isEmpty = false;
    _serial = nextSerial();
}

void PosedKeyframe::clear(std::size_t track)
{
    const auto first = _texels.begin() + 3 * track;
    std::fill(first, first + 3, glm::uvec4(POSE_NOT_SET));
    _isEmpty = std::all_of(_texels.begin(), _texels.end(),
                           [](const glm::uvec4& words) { return words == glm::uvec4(POSE_NOT_SET); });
    _serial = nextSerial();
}

void PosedKeyframe::clear()
{
    std::fill(_texels.begin(), _texels.end(), glm::uvec4(POSE_NOT_SET));
    _isEmpty = true;
    _serial = nextSerial();
}

std::optional<glm::vec4> PosedNumbers::unitRotation(const glm::vec4& rotation)
{
    const glm::dvec4 q(rotation);
    const double squared = glm::dot(q, q); // of floats: neither too large nor too small for a double
    if (!(squared > 0.0 && squared <= std::numeric_limits<double>::max())) return std::nullopt;
    return glm::vec4(q / std::sqrt(squared));
}

JointTransform PosedNumbers::decomposed(const glm::dmat4& matrix)
{
    glm::dmat3 axes(matrix);
    glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    if (glm::determinant(axes) < 0.0) scale.x = -scale.x;
    axes[0] /= scale.x;
    axes[1] = glm::normalize(axes[1] - glm::dot(axes[0], axes[1]) * axes[0]);
    axes[2] = glm::cross(axes[0], axes[1]);
    const glm::dvec4 rotation = Rotation::numbers(glm::quat_cast(axes));
    return {glm::vec4(glm::dvec4(glm::dvec3(matrix[3]), 0.0)), glm::vec4(rotation), glm::vec4(glm::dvec4(scale, 0.0))};
}

} // namespace osgGpuAnimation
