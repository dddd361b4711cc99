// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/JointPose.h>

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <optional>
#include <tuple>

namespace osgGpuAnimation
{

namespace
{

using namespace PosedNumbers;
using Part = PosedKeyframe::Part;

static_assert(maxNumber == JointPose::maxNumber, "the same limit for callers");

constexpr std::uint32_t partBits = 0xFu; ///< of PosedKeyframe::setNumbers(): the numbers of a joint's first part

std::string jointAt(const AnimationSet& set, std::size_t joint)
{
    return "joint " + std::to_string(joint) + " \"" + set.skeleton().joint(joint).name + "\"";
}

Error wrongCount(const char* what, std::size_t found, std::size_t expected)
{
    return Error{std::to_string(found) + " " + what + " for a skeleton of " + std::to_string(expected) + " joints"};
}

/// True if the extent contains the transform that these three texels hold.
bool contains(const PoseExtent::Joint& known, const glm::uvec4* texels)
{
    const auto isSet = [&](Part part) { return texels[part].w != POSE_NOT_SET; };
    const auto offset = [&](Part part, const glm::vec3& from)
    {
        glm::vec3 numbers;
        std::memcpy(&numbers, &texels[part], sizeof(numbers));
        return numbers - from;
    };
    if (isSet(Part::Rotation) && !known.turns) return false;
    if (isSet(Part::Translation))
    {
        // Of numbers too large for its square a translation is never inside, which costs new bounds only.
        const glm::vec3 moved = offset(Part::Translation, known.translation);
        if (!known.moves || !(glm::dot(moved, moved) <= 0.999f * known.shift * known.shift)) return false;
    }
    const glm::vec3 grown = glm::abs(offset(Part::Scale, known.scale));
    return !isSet(Part::Scale) || (known.scales && std::max({grown.x, grown.y, grown.z}) <= 0.999f * known.stretch);
}

/// Lets the ball or cube of an extent reach a value. It grows around its centre up to the fourfold margin, so that a
/// joint that swings soon stays inside; beyond that it begins anew around the value. It contains allowed values only.
void reach(bool& isKnown, glm::vec3& centre, float& radius, const glm::vec3& value, float distance, float margin)
{
    if (isKnown && distance <= 0.999f * radius) return;
    const bool grows = isKnown && distance <= 3.0f * margin;
    if (!grows) centre = value;
    const glm::vec3 size = glm::abs(centre);
    radius = std::min(grows ? distance + margin : margin, maxNumber - std::max({size.x, size.y, size.z}));
    isKnown = true;
}

} // namespace

JointPose::JointPose(std::shared_ptr<const AnimationSet> set)
    : _set(AnimationSet::orEmpty(std::move(set))), _keyframe(std::make_shared<PosedKeyframe>(_set->trackCount())),
      _extent(std::make_shared<const PoseExtent>())
{
}

JointPose::JointPose(const JointPose& other)
    : _set(other._set), _keyframe(std::make_shared<PosedKeyframe>(*other._keyframe)), _extent(other._extent)
{
}

JointPose& JointPose::operator=(const JointPose& other)
{
    if (this == &other) return *this;
    _set = other._set;
    _keyframe = std::make_shared<PosedKeyframe>(*other._keyframe);
    _isShared = false;
    _extent = other._extent;
    return *this;
}

bool JointPose::isEmpty() const
{
    return _keyframe->isEmpty();
}

std::shared_ptr<const PosedKeyframe> JointPose::sharedKeyframe() const
{
    _isShared = true;
    return _keyframe;
}

/// The keyframe, which nobody shares.
PosedKeyframe& JointPose::change()
{
    if (_isShared)
    {
        _keyframe = std::make_shared<PosedKeyframe>(*_keyframe);
        _isShared = false;
    }
    return *_keyframe;
}

void JointPose::setPart(std::size_t joint, std::size_t part, const glm::vec4& value)
{
    change().setPart(joint, static_cast<Part>(part), value);
    growExtent(joint, joint + 1);
}

bool JointPose::setTranslation(std::size_t joint, const glm::vec3& translation)
{
    if (!hasJoint(joint) || !isAllowed(translation)) return false;
    setPart(joint, Part::Translation, glm::vec4(translation, 0.0f));
    return true;
}

bool JointPose::setRotation(std::size_t joint, const glm::quat& rotation)
{
    const std::optional<glm::vec4> unit = unitRotation({rotation.x, rotation.y, rotation.z, rotation.w});
    if (!hasJoint(joint) || !unit) return false;
    setPart(joint, Part::Rotation, *unit);
    return true;
}

bool JointPose::setScale(std::size_t joint, const glm::vec3& scale)
{
    if (!hasJoint(joint) || !isAllowed(scale)) return false;
    setPart(joint, Part::Scale, glm::vec4(scale, 0.0f));
    return true;
}

bool JointPose::setTransform(std::size_t joint, const JointTransform& transform)
{
    if (!hasJoint(joint) || !isAllowed(transform)) return false;
    change().setTransform(joint, transform);
    growExtent(joint, joint + 1);
    return true;
}

bool JointPose::setMorphWeight(std::size_t morph, std::size_t target, float weight)
{
    const std::vector<MorphWeights>& morphs = _set->morphs();
    if (morph >= morphs.size() || target >= morphs[morph].defaults.size() || !isAllowed(weight)) return false;
    change().setNumber(_set->firstTrackOfMorph(morph) + target / MorphWeights::weightsPerBlock,
                       target % MorphWeights::weightsPerBlock, weight);
    if (!morphs[morph].isProperty()) growExtent(weight);
    return true;
}

Result<void> JointPose::setTransforms(const std::vector<JointTransform>& transforms)
{
    const std::size_t count = _set->skeleton().jointCount();
    if (transforms.size() != count) return wrongCount("transforms", transforms.size(), count);
    const bool isInside = _extent->containsAll(transforms);
    for (std::size_t joint = 0; joint < count && !isInside; ++joint)
        if (!isAllowed(transforms[joint]))
            return Error{jointAt(*_set, joint) + ": a number is not finite, or the rotation is 0"};
    if (_isShared && _keyframe->trackCount() == count)
    {
        _keyframe = std::make_shared<PosedKeyframe>(transforms, isInside);
        _isShared = false;
    }
    else
        change().setTransforms(transforms);
    if (!isInside) growExtent(0, count);
    return {};
}

Result<void> JointPose::setModelTransforms(const std::vector<AffineMatrix>& jointToModel)
{
    const Skeleton& skeleton = _set->skeleton();
    if (jointToModel.size() != skeleton.jointCount())
        return wrongCount("matrices", jointToModel.size(), skeleton.jointCount());
    thread_local std::vector<JointTransform> local;
    thread_local std::vector<glm::dmat4> shown; // without shears, so that joints keep their places below a sheared one
    local.clear();
    shown.clear();
    for (std::size_t joint = 0; joint < skeleton.jointCount(); ++joint)
    {
        const glm::dmat4 matrix = jointToModel[joint].toColumns();
        const double volume = glm::determinant(glm::dmat3(matrix));
        if (!jointToModel[joint].isFinite() || volume == 0.0)
            return Error{jointAt(*_set, joint) + ": its matrix is not finite or has no inverse"};
        const int parent = skeleton.joint(joint).parent; // checked before
        const glm::dmat4 above = parent < 0 ? glm::dmat4(1.0) : shown[parent];
        local.push_back(decomposed(glm::inverse(above) * matrix));
        shown.push_back(above * glm::dmat4(local.back().toMatrix().toColumns()));
    }
    return setTransforms(local);
}

void JointPose::reset()
{
    change().clear();
    renewExtent();
}

bool JointPose::reset(std::size_t joint)
{
    if (!hasJoint(joint)) return false;
    change().clear(joint);
    renewExtent();
    return true;
}

bool JointPose::resetMorph(std::size_t morph)
{
    if (morph >= _set->morphs().size()) return false;
    for (std::size_t block = 0; block < _set->morphs()[morph].blockCount(); ++block)
        change().clear(_set->firstTrackOfMorph(morph) + block);
    renewExtent();
    return true;
}

JointTransform JointPose::transform(std::size_t joint) const
{
    assert(hasJoint(joint) && "a joint of the set");
    const JointTransform posed = _keyframe->values(joint);
    const std::uint32_t numbers = _keyframe->setNumbers(joint);
    JointTransform transform = _set->restPose()[joint];
    for (std::size_t number = 0; number < 12; ++number)
        if ((numbers >> number & 1u) != 0) transform.number(number) = posed.number(number);
    return transform;
}

std::vector<JointPose::Track> JointPose::tracks() const
{
    std::vector<Track> tracks;
    for (std::size_t track = 0; track < _keyframe->trackCount(); ++track)
        if (const std::uint32_t numbers = _keyframe->setNumbers(track); numbers != 0)
            tracks.push_back({static_cast<std::uint32_t>(track), numbers, _keyframe->values(track)});
    return tracks;
}

Result<void> JointPose::setTracks(const std::vector<Track>& tracks)
{
    JointPose pose(_set);
    for (const Track& stored : tracks)
    {
        bool isGood = stored.track < _set->trackCount() && stored.numbers >> 12 == 0;
        if (isGood && hasJoint(stored.track))
        {
            const JointTransform& values = stored.values;
            const std::optional<glm::vec4> unit = unitRotation(values.rotation); // exactly that of setRotation()
            const std::tuple<Part, glm::vec4, bool> parts[] = {
                {Part::Translation, values.translation, isAllowed(glm::vec3(values.translation))},
                {Part::Rotation, unit.value_or(values.rotation), unit.has_value()},
                {Part::Scale, values.scale, isAllowed(glm::vec3(values.scale))}};
            for (const auto& [part, value, isGoodPart] : parts)
                if ((stored.numbers >> 4 * part & partBits) != 0)
                {
                    isGood = isGood && isGoodPart;
                    pose._keyframe->setPart(stored.track, part, value);
                }
            isGood = isGood && pose._keyframe->setNumbers(stored.track) == stored.numbers;
        }
        else if (isGood)
            for (std::size_t number = 0; number < 12; ++number)
            {
                if ((stored.numbers >> number & 1u) == 0) continue;
                const float weight = stored.values.number(number);
                isGood = isGood && isAllowed(weight);
                pose._keyframe->setNumber(stored.track, number, weight);
            }
        if (!isGood)
            return Error{"a pose with values of track " + std::to_string(stored.track) + " of " +
                         std::to_string(_set->trackCount()) + " that cannot be"};
    }
    *this = pose;
    renewExtent();
    return {};
}

/// Makes a larger extent if one of these joints has left the present one.
void JointPose::growExtent(std::size_t firstJoint, std::size_t endJoint)
{
    std::shared_ptr<PoseExtent> grown;
    float longest = 0.0f;
    for (std::size_t joint = firstJoint; joint < endJoint; ++joint)
    {
        if (joint < _extent->joints.size() && contains(_extent->joints[joint], &_keyframe->texels()[3 * joint]))
            continue;
        const std::uint32_t numbers = _keyframe->setNumbers(joint);
        if (numbers == 0) continue;
        if (!grown) longest = longestJoint(_set->skeleton());
        if (!grown) grown = std::make_shared<PoseExtent>(*_extent);
        grown->joints.resize(_set->skeleton().jointCount());
        PoseExtent::Joint& known = grown->joints[joint];
        const auto has = [&](Part part) { return (numbers >> 4 * part & partBits) != 0; };
        const JointTransform posed = transform(joint);
        known.turns = has(Part::Rotation);
        // The margin of a translation is an eighth of the way from the rest pose or of the longest joint.
        const glm::vec3 rest(_set->restPose()[joint].translation), place(posed.translation), scale(posed.scale);
        const glm::vec3 size = glm::abs(scale), grownBy = glm::abs(scale - known.scale);
        if (has(Part::Translation))
            reach(known.moves, known.translation, known.shift, place, glm::distance(known.translation, place),
                  std::max(glm::distance(place, rest), longest) / 8.0f);
        if (has(Part::Scale))
            reach(known.scales, known.scale, known.stretch, scale, std::max({grownBy.x, grownBy.y, grownBy.z}),
                  std::max({size.x, size.y, size.z}) / 8.0f);
    }
    if (grown) _extent = grown;
}

void JointPose::growExtent(float weight)
{
    const double size = std::abs(static_cast<double>(weight));
    if (_extent->maxWeight > 0.0 && size <= _extent->maxWeight) return;
    const auto grown = std::make_shared<PoseExtent>(*_extent);
    grown->maxWeight = size <= 1.0 ? 1.0 : 1.25 * size;
    _extent = grown;
}

/// Makes an extent of the present values alone.
void JointPose::renewExtent()
{
    _extent = std::make_shared<const PoseExtent>();
    if (isEmpty()) return;
    growExtent(0, _set->skeleton().jointCount());
    for (std::size_t morph = 0; morph < _set->morphs().size(); ++morph)
    {
        const MorphWeights& weights = _set->morphs()[morph];
        if (weights.isProperty()) continue;
        const std::size_t first = _set->firstTrackOfMorph(morph);
        for (std::size_t track = first; track < first + weights.blockCount(); ++track)
        {
            const std::uint32_t numbers = _keyframe->setNumbers(track);
            for (std::size_t number = 0; number < 12; ++number)
                if ((numbers >> number & 1u) != 0) growExtent(_keyframe->values(track).number(number));
        }
    }
}

} // namespace osgGpuAnimation
