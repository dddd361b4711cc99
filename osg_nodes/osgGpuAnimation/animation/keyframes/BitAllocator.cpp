// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/BitAllocator.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr std::array<glm::vec4 JointTransform::*, 3> partsOfTracks{&JointTransform::translation,
                                                                   &JointTransform::rotation, &JointTransform::scale};
constexpr std::size_t rotationPart = 1;

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
                keys.range(place = keys.omittedPlace(), moving.least, moving.most);
            else
                keys.range(moving.least, moving.most);
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
        one.setRange(moving.least, moving.most, bits);
    };
    if (part == rotationPart)
        set(track.rotation);
    else
        set(part == 0 ? track.translation : track.scale);
}

glm::uvec3 BitAllocator::bitsOf(std::size_t joint, std::size_t part) const
{
    const CompactTracks::Track& track = _tracks.tracks[joint];
    return part == 0 ? track.translation.bits : part == rotationPart ? track.rotation.bits : track.scale.bits;
}

void BitAllocator::round(std::size_t joint)
{
    for (std::size_t at = joint; at < _wanted.size(); at += _set.trackCount())
    {
        _rounded[at] = _wanted[at];
        CompactTracks::round(_tracks.tracks[joint], _rounded[at]);
    }
}

/// Calls visit(number) for the moving numbers of the joint and its ancestors that may have more bits.
template <typename Visit>
void BitAllocator::forNumbersAbove(std::size_t joint, Visit visit) const
{
    for (int above = static_cast<int>(joint); above >= 0;
         above = _set.skeleton().joint(static_cast<std::size_t>(above)).parent)
        for (std::size_t part = 0; part < partCount; ++part)
        {
            if (!_moving[static_cast<std::size_t>(above)][part].isMoving) continue;
            const glm::uvec3 bits = bitsOf(static_cast<std::size_t>(above), part);
            for (int axis = 0; axis < 3; ++axis)
                if (bits[axis] < CompactTracks::mostBits) visit(Number{static_cast<std::size_t>(above), part, axis});
        }
}

float BitAllocator::largestError(const Number& number) const
{
    const Moving& moving = _moving[number.joint][number.part];
    const CompactTracks::Track& track = _tracks.tracks[number.joint];
    const CompactTracks::Part& part = number.part == 0              ? track.translation
                                      : number.part == rotationPart ? track.rotation
                                                                    : track.scale;
    const float step =
        part.bits[number.axis] == 0 ? moving.most[number.axis] - moving.least[number.axis] : part.step[number.axis];
    return 0.5f * step;
}

/// The way of the joint's point if the number is off by its largest error.
double BitAllocator::effect(const std::vector<JointTransform>& pose, const Number& number, std::size_t joint,
                            const glm::vec3& point)
{
    JointTransform off = pose[number.joint];
    const float error = largestError(number);
    if (number.part == rotationPart)
    {
        std::uint32_t place = _tracks.tracks[number.joint].rotation.place;
        glm::vec3 components = CompactTracks::componentsOf(off.rotation, place);
        components[number.axis] += components[number.axis] > 0.0f ? -error : error;
        off.rotation = CompactTracks::rotationOf(components, place);
    }
    else
        (off.*partsOfTracks[number.part])[number.axis] += error;

    glm::vec3 right = point, wrong = point;
    for (int above = static_cast<int>(joint); above >= 0;)
    {
        const auto index = static_cast<std::size_t>(above);
        const AffineMatrix matrix = pose[index].toMatrix();
        right = matrix.transformPoint(right);
        wrong = (index == number.joint ? off.toMatrix() : matrix).transformPoint(wrong);
        above = _set.skeleton().joint(index).parent;
    }
    return static_cast<double>(glm::distance(right, wrong));
}

void BitAllocator::addBit(const Number& number)
{
    glm::uvec3 bits = bitsOf(number.joint, number.part);
    const float before = largestError(number);
    // The first bits of a narrow range gain nothing: it is rounded to units.
    do
    {
        ++bits[number.axis];
        setBits(number.joint, number.part, bits);
    } while (bits[number.axis] < CompactTracks::mostBits && !(largestError(number) < before));
}

void BitAllocator::begin(const PoseDistance& distance, double most)
{
    const std::vector<JointTransform> pose(_rounded.begin(),
                                           _rounded.begin() + static_cast<std::ptrdiff_t>(_set.trackCount()));
    for (std::size_t joint = 0; joint < _moving.size(); ++joint)
        forNumbersAbove(joint,
                        [&](const Number& number)
                        {
                            const glm::vec3& point = distance.points(joint).back();
                            while (bitsOf(number.joint, number.part)[number.axis] < CompactTracks::mostBits &&
                                   effect(pose, number, joint, point) > most)
                                addBit(number);
                        });
    for (std::size_t joint = 0; joint < _moving.size(); ++joint)
        round(joint);
}

bool BitAllocator::raise(const std::vector<JointTransform>& pose, const PoseDistance::Worst& worst)
{
    Number best;
    double largest = 0.0;
    forNumbersAbove(worst.joint,
                    [&](const Number& number)
                    {
                        const double way = effect(pose, number, worst.joint, worst.point);
                        if (!(way > largest)) return;
                        largest = way;
                        best = number;
                    });
    if (!(largest > 0.0)) return false;
    addBit(best);
    round(best.joint);
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
        if (track.rotation.place != CompactTracks::largestPlace) hold(track.rotation, &JointTransform::rotation);
        hold(track.scale, &JointTransform::scale);
    }
    return outTracks.pack(outData, _set.trackCount());
}

} // namespace osgGpuAnimation
