// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// The content of a JointPose in the layout of the GPU: three texels per track, where a number that is not set has the
/// bits POSE_NOT_SET. A part of a joint (translation, rotation, scale) is set as a whole, a morph weight alone.
class PosedKeyframe
{
public:
    /// The parts of a joint; the order is that of the texels.
    enum Part : std::size_t
    {
        Translation,
        Rotation,
        Scale,
    };

    /// Nothing is set.
    explicit PosedKeyframe(std::size_t trackCount);
    /// All tracks are joints, and all their parts are set as by setTransforms(). areStoredAsTheyAre: all transforms
    /// are, see PosedNumbers::isStoredAsItIs().
    PosedKeyframe(const std::vector<JointTransform>& transforms, bool areStoredAsTheyAre);

    std::size_t trackCount() const { return _texels.size() / 3; }
    const std::vector<glm::uvec4>& texels() const { return _texels; }
    std::size_t byteSize() const { return _texels.size() * sizeof(glm::uvec4); }
    /// Identifies the content: keyframes of equal serials are equal. Never 0.
    std::uint64_t serial() const { return _serial; }
    bool isEmpty() const { return _isEmpty; } ///< true if nothing is set
    /// One bit per number of the track that is set, in the order of JointTransform::number().
    std::uint32_t setNumbers(std::size_t track) const;
    /// The numbers of a track, 0 where nothing is set.
    JointTransform values(std::size_t track) const;
    /// The same for the mix stage. outCover: 1 for each number that is set, else 0.
    MixedTrack sample(std::size_t track, MixedTrack& outCover) const;

    // Each change gives the keyframe another serial. The numbers are not checked.
    void setPart(std::size_t joint, Part part, const glm::vec4& value);
    void setTransform(std::size_t joint, const JointTransform& transform); ///< gives it a unit rotation
    void setTransforms(const std::vector<JointTransform>& transforms);     ///< of the first tracks
    void setNumber(std::size_t track, std::size_t number, float value);
    void clear(std::size_t track);
    void clear();

private:
    std::vector<glm::uvec4> _texels;
    std::uint64_t _serial;
    bool _isEmpty = true;
};

/// The values that a pose may hold.
namespace PosedNumbers
{

constexpr float maxNumber = 1e18f; ///< the largest absolute value
/// False beyond ±maxNumber and for NaN.
inline bool isAllowed(float number)
{
    return std::abs(number) <= maxNumber;
}
inline bool isAllowed(const glm::vec3& numbers)
{
    return isAllowed(numbers.x) && isAllowed(numbers.y) && isAllowed(numbers.z);
}
/// The unit quaternion; none if it has no direction.
std::optional<glm::vec4> unitRotation(const glm::vec4& rotation);
/// True if all parts are allowed and the rotation has a direction.
inline bool isAllowed(const JointTransform& transform)
{
    const float squared = glm::dot(transform.rotation, transform.rotation); // usually 1
    const bool hasDirection = (squared > 1e-20f && squared < 1e20f) || unitRotation(transform.rotation).has_value();
    return hasDirection && isAllowed(glm::vec3(transform.translation)) && isAllowed(glm::vec3(transform.scale));
}
/// True if a keyframe takes the transform without a change, as in streams of whole skeletons: it has a unit rotation
/// and 0 in the fourth numbers. The mix stage normalizes what rounding leaves.
inline bool isStoredAsItIs(const JointTransform& transform)
{
    const float squared = glm::dot(transform.rotation, transform.rotation);
    const bool isUnit = std::abs(squared - 1.0f) < 1e-6f;
    return isUnit & (transform.translation.w == 0.0f) & (transform.scale.w == 0.0f);
}
/// T · R · S of a matrix with an inverse, by its columns. A shear is dropped: the rotation keeps the direction of the
/// first column and the plane of the first two.
JointTransform decomposed(const glm::dmat4& matrix);

} // namespace PosedNumbers

} // namespace osgGpuAnimation
