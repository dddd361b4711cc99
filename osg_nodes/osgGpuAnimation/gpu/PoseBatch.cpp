// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <osgGpuAnimation/animation/constraints/AxisTurns.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <layout.glsl>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace osgGpuAnimation
{

namespace
{

/// NaN counts as 0.
float clampedToUnit(float value)
{
    return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

bool isPlain(const BlendSample& sample)
{
    return sample.weight == 1.0f && (sample.control & (POSE_SAMPLE_ADDITIVE | POSE_SAMPLE_POSED)) == 0 &&
           sample.control >> POSE_SAMPLE_MASK_SHIFT == 0;
}

/// Null if the sample shows no pose of a set with that many tracks, or one in which nothing is set.
const JointPose* findPose(const PoseInstruction& instruction, const BlendSample& sample, std::size_t trackCount)
{
    if (sample.keyframe >= instruction.poses.size()) return nullptr;
    const JointPose* pose = instruction.poses[sample.keyframe].get();
    return pose && !pose->isEmpty() && pose->keyframe().trackCount() == trackCount ? pose : nullptr;
}

PoseBatch::BlendCost blendCost(bool isPosed, bool isMixed, std::size_t sampleCount)
{
    if (isPosed) return PoseBatch::BlendCost::Posed;
    if (!isMixed) return PoseBatch::BlendCost::Plain;
    return sampleCount <= 4 ? PoseBatch::BlendCost::Few : PoseBatch::BlendCost::Many;
}

bool isFinite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isDirected(const ConstraintTarget& target)
{
    return target.twist != 0.0f || target.pole != glm::vec3(0.0f) || target.rotation != glm::vec4(0.0f);
}

/// A target of model space in the space of the palette, as shaders need it: with no effect unless all is finite.
ConstraintTarget inSpaceOf(const ConstraintTarget& target, const AffineMatrix& rootMatrix)
{
    ConstraintTarget moved = target;
    moved.weight = clampedToUnit(target.weight);
    moved.position = rootMatrix.transformPoint(target.position);
    moved.pole = rootMatrix.transformVector(target.pole);
    if (target.rotation != glm::vec4(0.0f))
    {
        // Shaders use the directions of x and of y across x, which follow matrices that scale, mirror or shear.
        const glm::dmat3 toPalette(rootMatrix.toColumns());
        const glm::dquat rotation = Rotation::unitQuaternion(target.rotation);
        const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
        const auto movedTo = [&](const glm::dvec3& axis)
        { return AxisTurns::direction(toPalette * (rotation * axis), axis); };
        moved.rotation = Rotation::toFloats(AxisTurns::framed(x, y, movedTo(x), movedTo(y)));
    }
    // Shaders compute sines of small angles only.
    constexpr float wholeTurn = 6.28318531f;
    if (std::abs(target.twist) > 0.5f * wholeTurn) moved.twist = std::remainder(target.twist, wholeTurn);
    const bool isGood = isFinite(moved.position) && isFinite(moved.pole) && std::isfinite(moved.twist) &&
                        isFinite(glm::vec3(moved.rotation)) && std::isfinite(moved.rotation.w);
    return moved.weight > 0.0f && isGood ? moved : ConstraintTarget();
}

} // namespace

PoseBatch::BlendCost PoseBatch::blendCostOf(const PoseInstruction& instruction)
{
    const auto isPosedSample = [&](const BlendSample& sample)
    {
        if ((sample.control & POSE_SAMPLE_POSED) == 0 || sample.keyframe >= instruction.poses.size()) return false;
        const std::shared_ptr<const JointPose>& pose = instruction.poses[sample.keyframe];
        return pose && !pose->isEmpty();
    };
    const auto end = instruction.samples.begin() + static_cast<std::ptrdiff_t>(instruction.sampleCount);
    const bool isPosed = !instruction.poses.empty() && std::any_of(instruction.samples.begin(), end, isPosedSample);
    const bool isMixed = instruction.sampleCount != 1 || !isPlain(instruction.samples[0]);
    return blendCost(isPosed, isMixed, instruction.sampleCount);
}

bool PoseBatch::accepts(const PoseInstruction& instruction) const
{
    if (_size > 0 && _targets.empty() != instruction.targets.empty()) return false;
    return _size < minBatchSize || blendCostOf(instruction) == blendCost(_needs.posed, _needs.mixing, _sampleStride);
}

/// Gives a posed sample its keyframe in the batch. False if there is none.
bool PoseBatch::usePose(const PoseInstruction& instruction, BlendSample& sample)
{
    const JointPose* pose = findPose(instruction, sample, set().trackCount());
    if (!pose) return false;
    if (_firstPosed.empty()) _firstPosed.assign(_size + 1, 0);
    sample.keyframe = static_cast<std::uint32_t>(_posed.size());
    _posed.push_back(pose->sharedKeyframe());
    _maxPosed = std::max<std::size_t>(_maxPosed, _posed.size() - _firstPosed[_size]);
    _needs.posed = true;
    return true;
}

std::size_t PoseBatch::append(const BlendSample* samples, std::size_t count, const PoseInstruction* instruction)
{
    if (count > _sampleStride)
    {
        std::vector<BlendSample> widened(_size * count, BlendSample{0, 0.0f, 0.0f, 0});
        for (std::size_t instance = 0; instance < _size; ++instance)
            for (std::size_t i = 0; i < _sampleStride; ++i)
                widened[instance * count + i] = _samples[instance * _sampleStride + i];
        _samples = std::move(widened);
        _sampleStride = count;
    }
    if (!_firstPosed.empty()) _firstPosed.push_back(static_cast<std::uint32_t>(_posed.size()));
    for (const BlendSample* sample = samples; sample != samples + count; ++sample)
    {
        _samples.push_back(*sample);
        BlendSample& added = _samples.back();
        added.alpha = clampedToUnit(sample->alpha);
        added.weight = clampedToUnit(sample->weight);
        if ((added.control & POSE_SAMPLE_POSED) != 0 && !(instruction && usePose(*instruction, added)))
        {
            // Nothing is set: the sample keeps its place and shows nothing.
            added = {0, 0.0f, 0.0f, added.control & ~POSE_SAMPLE_POSED};
        }
        _needs.layers = _needs.layers || (added.control & POSE_SAMPLE_ABOVE) != 0;
        _needs.additive = _needs.additive || (added.control & POSE_SAMPLE_ADDITIVE) != 0;
        _needs.masks = _needs.masks || added.control >> POSE_SAMPLE_MASK_SHIFT != 0;
        _needs.mixing = _needs.mixing || !isPlain(added);
        // A mask that nobody holds any more is no mask.
        if (!holdMask(added.control >> POSE_SAMPLE_MASK_SHIFT)) added.control &= (1u << POSE_SAMPLE_MASK_SHIFT) - 1u;
    }
    _samples.resize((_size + 1) * _sampleStride, BlendSample{0, 0.0f, 0.0f, 0});
    _needs.mixing = _needs.mixing || _sampleStride > 1;
    if (!_rootMatrices.empty() && !_isRootCommon) _rootMatrices.emplace_back();
    if (!_tints.empty()) _tints.push_back(white);
    return _size++;
}

/// The targets of the last instance.
void PoseBatch::addTargets(const std::vector<ConstraintTarget>& targets, const AffineMatrix& rootMatrix)
{
    const std::size_t count = set().constraints().size();
    if (targets.empty() || targets.size() != count) // none, or those of another set
    {
        if (!_targets.empty()) _targets.resize(_size * count);
        return;
    }
    _targets.resize((_size - 1) * count);
    _targets.insert(_targets.end(), targets.begin(), targets.end());
    const bool isRootIdentity = rootMatrix.isIdentity();
    ConstraintTarget* place = _targets.data() + (_size - 1) * count;
    for (std::size_t c = 0; c < count; ++c)
    {
        const ConstraintTarget& target = targets[c];
        const std::uint64_t bit = std::uint64_t(1) << c;
        const bool isReady = isRootIdentity && target.weight > 0.0f && target.weight <= 1.0f && !isDirected(target) &&
                             isFinite(target.position);
        if (!isReady)
        {
            place[c] = inSpaceOf(target, rootMatrix);
            if (!(place[c].weight > 0.0f)) continue;
            if (isDirected(place[c])) _needs.directedTargets |= bit;
        }
        _needs.constraints |= bit;
        if (place[c].weight < 1.0f) _needs.partialTargets |= bit;
    }
}

std::size_t PoseBatch::addInstance(const PoseInstruction& instruction, const AffineMatrix& rootMatrix)
{
    const std::size_t instance = append(instruction.samples.data(),
                                        std::min(instruction.sampleCount, PoseInstruction::maxSamples), &instruction);
    addTargets(instruction.targets, rootMatrix);
    return instance;
}

/// False if there is no such mask.
bool PoseBatch::holdMask(std::uint32_t number)
{
    if (number == 0) return true;
    if (number >= _masks.size()) _masks.resize(number + 1);
    if (!_masks[number]) _masks[number] = set().masks().find(number);
    return _masks[number] != nullptr;
}

std::size_t PoseBatch::add(const PoseInstruction& instruction)
{
    return addInstance(instruction, _isRootCommon ? _rootMatrices.front() : AffineMatrix());
}

bool PoseBatch::hasPoses(std::size_t instance, const PoseInstruction& instruction) const
{
    std::size_t posed = firstPosed(instance);
    for (std::size_t i = 0; i < instruction.sampleCount; ++i)
    {
        const BlendSample& sample = instruction.samples[i];
        if ((sample.control & POSE_SAMPLE_POSED) == 0) continue;
        const JointPose* pose = findPose(instruction, sample, set().trackCount());
        if (!pose) continue;
        if (posed >= firstPosed(instance + 1) || _posed[posed++]->serial() != pose->keyframe().serial()) return false;
    }
    return posed == firstPosed(instance + 1);
}

void PoseBatch::setRootMatrix(const AffineMatrix& rootMatrix)
{
    assert(_size == 0 && "the root matrix is set before the first instance");
    _isRootCommon = !rootMatrix.isIdentity();
    _rootMatrices.assign(_isRootCommon ? 1 : 0, rootMatrix);
}

bool PoseBatch::hasRootMatrix(const AffineMatrix& rootMatrix) const
{
    return _isRootCommon ? _rootMatrices.front() == rootMatrix : _rootMatrices.empty() && rootMatrix.isIdentity();
}

std::size_t PoseBatch::add(const PoseInstruction& instruction, const AffineMatrix& rootMatrix)
{
    assert(!_isRootCommon && "the batch has one root matrix for all");
    const std::size_t instance = addInstance(instruction, rootMatrix);
    _rootMatrices.resize(_size);
    _rootMatrices.back() = rootMatrix;
    return instance;
}

std::size_t PoseBatch::addSample(const BlendSample& sample, const AffineMatrix& rootMatrix)
{
    assert(!_isRootCommon && "the batch has one root matrix for all");
    const std::size_t instance = append(&sample, 1, nullptr);
    addTargets({}, rootMatrix);
    _rootMatrices.resize(_size);
    _rootMatrices.back() = rootMatrix;
    return instance;
}

void PoseBatch::setTint(std::size_t instance, std::uint32_t rgba)
{
    if (_tints.empty() && rgba == white) return;
    _tints.resize(_size, white);
    _tints[instance] = rgba;
}

bool PoseBatch::isSame(const PoseBatch& other) const
{
    const auto same = [](const auto& left, const auto& right)
    {
        return left.size() == right.size() &&
               (left.empty() || std::memcmp(left.data(), right.data(), left.size() * sizeof(left[0])) == 0);
    };
    return _set == other._set && _sampleStride == other._sampleStride && same(_samples, other._samples) &&
           same(_rootMatrices, other._rootMatrices) && same(_tints, other._tints) && same(_targets, other._targets) &&
           std::equal(_posed.begin(), _posed.end(), other._posed.begin(), other._posed.end(),
                      [](const auto& left, const auto& right) { return left->serial() == right->serial(); });
}

void PoseBatch::clear()
{
    _size = 0;
    _sampleStride = 1;
    _needs = Needs();
    _samples.clear();
    _rootMatrices.clear();
    _isRootCommon = false;
    _tints.clear();
    _targets.clear();
    _masks.clear();
    _posed.clear();
    _firstPosed.clear();
    _maxPosed = 0;
}

void PoseBatch::reset(std::shared_ptr<const AnimationSet> set)
{
    clear();
    _set = std::move(set);
}

} // namespace osgGpuAnimation
