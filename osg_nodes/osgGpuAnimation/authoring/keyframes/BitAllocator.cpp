// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/keyframes/BitAllocator.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

constexpr std::array<glm::vec4 JointTransform::*, 3> partsOfTracks{&JointTransform::translation,
                                                                   &JointTransform::rotation, &JointTransform::scale};
constexpr std::size_t rotationPart = 1;

const CompactTracks::Part& partOf(const CompactTracks::Track& track, std::size_t part)
{
    if (part == rotationPart) return track.rotation;
    return part == 0 ? track.translation : track.scale;
}

} // namespace

BitAllocator::BitAllocator(const AnimationSet& set, std::vector<JointTransform> wanted)
    : _set(set), _wanted(std::move(wanted)), _rounded(_wanted), _moving(set.skeleton().jointCount())
{
    const std::size_t stride = set.trackCount();
    _tracks.tracks.resize(_moving.size());
    for (std::size_t joint = 0; joint < _moving.size(); ++joint)
    {
        for (std::size_t part = 0; part < partCount; ++part)
        {
            const PartKeys keys{&_wanted[joint], stride, _wanted.size() / stride, partsOfTracks[part]};
            Moving& moving = _moving[joint][part];
            moving.isMoving = keys.move();
            if (!moving.isMoving) continue;
            std::uint32_t& place = _tracks.tracks[joint].rotation.place;
            if (part == rotationPart)
                keys.range(place = keys.omittedPlace(), moving.min, moving.max);
            else
                keys.range(moving.min, moving.max);
            setBits(joint, part, glm::uvec3(0u));
        }
        round(joint);
    }
}

void BitAllocator::setBits(std::size_t joint, std::size_t part, const glm::uvec3& bits)
{
    CompactTracks::Track& track = _tracks.tracks[joint];
    const Moving& moving = _moving[joint][part];
    const auto set = [&](auto& one)
    {
        one.firstBit = 0;
        one.setRange(moving.min, moving.max, bits);
    };
    if (part == rotationPart)
        set(track.rotation);
    else
        set(part == 0 ? track.translation : track.scale);
}

glm::uvec3 BitAllocator::bitsOf(std::size_t joint, std::size_t part) const
{
    return partOf(_tracks.tracks[joint], part).bits;
}

void BitAllocator::round(std::size_t joint)
{
    for (std::size_t at = joint; at < _wanted.size(); at += _set.trackCount())
    {
        _rounded[at] = _wanted[at];
        CompactTracks::round(_tracks.tracks[joint], _rounded[at]);
    }
}

/// Calls visit(number) for the moving numbers of the joint that may have more bits.
template <typename Visit>
void BitAllocator::forNumbers(std::size_t joint, Visit visit) const
{
    for (std::size_t part = 0; part < partCount; ++part)
        for (int axis = 0; _moving[joint][part].isMoving && axis < 3; ++axis)
            if (bitsOf(joint, part)[axis] < CompactTracks::maxBits) visit(Number{joint, part, axis});
}

float BitAllocator::maxError(const Number& number) const
{
    const Moving& moving = _moving[number.joint][number.part];
    const CompactTracks::Part& part = partOf(_tracks.tracks[number.joint], number.part);
    const float step =
        part.bits[number.axis] == 0 ? moving.max[number.axis] - moving.min[number.axis] : part.step[number.axis];
    return 0.5f * step;
}

/// The way of a point in the joint's space if the number is off by its largest error. transform: the joint's.
double BitAllocator::effect(const JointTransform& transform, const Number& number, const glm::vec3& point,
                            const std::vector<AffineMatrix>& jointToModel) const
{
    JointTransform off = transform;
    const float error = maxError(number);
    if (number.part == rotationPart)
    {
        std::uint32_t place = _tracks.tracks[number.joint].rotation.place;
        glm::vec3 components = CompactTracks::componentsOf(off.rotation, place);
        components[number.axis] += components[number.axis] > 0.0f ? -error : error;
        off.rotation = CompactTracks::rotationOf(components, place);
    }
    else
        (off.*partsOfTracks[number.part])[number.axis] += error;
    const glm::vec3 way = off.toMatrix().transformPoint(point) - transform.toMatrix().transformPoint(point);
    const int parent = _set.skeleton().joint(number.joint).parent;
    return static_cast<double>(glm::length(parent < 0 ? way : jointToModel[parent].transformVector(way)));
}

void BitAllocator::addBit(const Number& number)
{
    glm::uvec3 bits = bitsOf(number.joint, number.part);
    const float before = maxError(number);
    // The first bits of a narrow range gain nothing: it is rounded to units.
    do
    {
        ++bits[number.axis];
        setBits(number.joint, number.part, bits);
    } while (bits[number.axis] < CompactTracks::maxBits && !(maxError(number) < before));
}

void BitAllocator::begin(const PoseDistance& distance, double max)
{
    const std::vector<JointTransform> pose(_rounded.begin(), _rounded.begin() + _set.trackCount());
    std::vector<AffineMatrix> jointToModel;
    Pose::jointToModel(_set, pose, AffineMatrix(), jointToModel);
    // Of each joint a point that it moves far: its own one, or that of a child. In its own space.
    std::vector<glm::vec3> far(_moving.size());
    for (std::size_t joint = 0; joint < far.size(); ++joint)
        far[joint] = distance.points(joint).back();
    for (std::size_t joint = far.size(); joint-- > 0;)
    {
        forNumbers(joint,
                   [&](const Number& number)
                   {
                       while (bitsOf(joint, number.part)[number.axis] < CompactTracks::maxBits &&
                              effect(pose[joint], number, far[joint], jointToModel) > max)
                           addBit(number);
                   });
        round(joint);
        const int parent = _set.skeleton().joint(joint).parent;
        if (parent < 0) continue;
        const glm::vec3 inParent = pose[joint].toMatrix().transformPoint(far[joint]);
        glm::vec3& farther = far[parent];
        if (glm::length(inParent) > glm::length(farther)) farther = inParent;
    }
}

bool BitAllocator::raise(const std::vector<JointTransform>& pose, const PoseDistance& distance,
                         const PoseDistance::Worst& worst)
{
    // Numbers of nearly the same effect are raised together: one at a time takes long for deep skeletons.
    constexpr double share = 0.9;
    _effects.clear();
    double max = 0.0;
    glm::vec3 point = worst.point;
    for (int joint = static_cast<int>(worst.joint); joint >= 0;)
    {
        const auto index = static_cast<std::size_t>(joint);
        forNumbers(index,
                   [&](const Number& number)
                   {
                       _effects.emplace_back(effect(pose[index], number, point, distance.jointToModel()), number);
                       max = std::max(max, _effects.back().first);
                   });
        point = pose[index].toMatrix().transformPoint(point);
        joint = _set.skeleton().joint(index).parent;
    }
    if (!(max > 0.0)) return false;
    for (const auto& [way, number] : _effects)
    {
        if (!(way >= share * max)) continue;
        addBit(number);
        round(number.joint);
    }
    return true;
}

bool BitAllocator::finish(CompactTracks& outTracks, std::vector<JointTransform>& outData)
{
    outTracks = _tracks;
    outData = _wanted;
    for (std::size_t joint = 0; joint < _moving.size(); ++joint)
    {
        CompactTracks::Track& track = outTracks.tracks[joint];
        // A part that never differs from its base is constant.
        const auto hold = [&](CompactTracks::Part& part, glm::vec4 JointTransform::*which)
        {
            if (!part.isMoving() || part.bits != glm::uvec3(0u)) return;
            for (std::size_t at = joint; at < outData.size(); at += _set.trackCount())
                outData[at].*which = _rounded[at].*which;
            part.firstBit = -1;
        };
        hold(track.translation, &JointTransform::translation);
        if (track.rotation.place != CompactTracks::maxPlace) hold(track.rotation, &JointTransform::rotation);
        hold(track.scale, &JointTransform::scale);
    }
    return outTracks.pack(outData, _set.trackCount());
}

} // namespace osgGpuAnimation
