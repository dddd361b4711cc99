// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>

#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// The sphere around the transformed box.
glm::vec4 sphereAround(const Box& box, const AffineMatrix& matrix)
{
    if (box.empty()) return {matrix.rows[0].w, matrix.rows[1].w, matrix.rows[2].w, -1.0f};
    const glm::vec3 half = (box.max - box.min) * 0.5f;
    float radius = 0.0f; // the longest half diagonal; opposite corners have equal distances
    for (const glm::vec3 side : {glm::vec3(1, 1, 1), glm::vec3(-1, 1, 1), glm::vec3(1, -1, 1), glm::vec3(1, 1, -1)})
        radius = std::max(radius, glm::length(matrix.transformVector(half * side)));
    return glm::vec4(matrix.transformPoint((box.min + box.max) * 0.5f), radius);
}

/// All constraints of the set, as bits: any of them may have targets.
std::uint64_t anyConstraints(const AnimationSet& set)
{
    return set.constraints().empty() ? 0 : ~std::uint64_t(0);
}

/// Removes an element by moving the last one to its place.
template <typename Element>
void takeOut(std::vector<Element>& elements, std::size_t index)
{
    if (index + 1 != elements.size()) elements[index] = std::move(elements.back());
    elements.pop_back();
}

} // namespace

CrowdInstances::CrowdInstances(const CrowdInstances& other)
    : _set(other._set), _clock(other._clock), _clipBounds(other._clipBounds), _allBounds(other._allBounds),
      _mixBounds(other._mixBounds), _rootMatrices(other._rootMatrices), _positions(other._positions),
      _cells(other._cells), _scales(other._scales), _tints(other._tints), _outfits(other._outfits),
      _proportions(other._proportions), _playbacks(other._playbacks), _isControlledKnown(false),
      _handles(other._handles), _indexOfPlace(other._indexOfPlace), _usesOfPlace(other._usesOfPlace),
      _freePlaces(other._freePlaces), _tinted(other._tinted), _userData(other._userData)
{
    for (const std::unique_ptr<AnimationController>& controller : other._controllers)
        _controllers.push_back(controller ? std::make_unique<AnimationController>(*controller) : nullptr);
    for (const std::unique_ptr<PosedBox>& box : other._posedBoxes)
        _posedBoxes.push_back(box ? std::make_unique<PosedBox>(*box) : nullptr);
    for (const auto& [handle, machine] : other._machines)
        _machines.emplace(handle, std::make_unique<StateMachine>(*machine));
}

std::size_t CrowdInstances::indexOf(Handle handle) const
{
    const std::size_t place = placeOf(handle);
    if (place >= _indexOfPlace.size() || _usesOfPlace[place] != handle >> 32) return none;
    const std::size_t index = _indexOfPlace[place];
    return index < size() && _handles[index] == handle ? index : none;
}

CrowdInstances::Handle CrowdInstances::newHandle(std::size_t index)
{
    if (_freePlaces.empty())
    {
        _freePlaces.push_back(static_cast<std::uint32_t>(_indexOfPlace.size()));
        _indexOfPlace.push_back(0);
        _usesOfPlace.push_back(0);
    }
    const std::uint32_t place = _freePlaces.back();
    _freePlaces.pop_back();
    _indexOfPlace[place] = static_cast<std::uint32_t>(index);
    return Handle(_usesOfPlace[place]) << 32 | place;
}

void CrowdInstances::setClipBounds(const std::vector<Box>& clipBounds, std::shared_ptr<const MixBounds> mixBounds)
{
    _clipBounds = clipBounds;
    _mixBounds = std::move(mixBounds);
    _allBounds = Box();
    for (const Box& box : clipBounds)
        _allBounds.add(box);
    if (_mixBounds && !_set->constraints().empty())
    {
        std::vector<PlayedClip> all;
        for (int clip = -1; clip < static_cast<int>(_set->clips().size()); ++clip)
            all.push_back({clip, PlayedClip::Part::Mixed});
        if (const Box constrained = _mixBounds->box(all, anyConstraints(*_set)); !constrained.empty())
            _allBounds.add(constrained);
    }
    for (std::size_t index = 0; index < size(); ++index)
    {
        _posedBoxes[index].reset();
        updatePosedBox(index);
        updateMember(index);
    }
}

// A controller may mix any clips.
const Box& CrowdInstances::boxOf(std::size_t index) const
{
    if (_posedBoxes[index]) return _posedBoxes[index]->box;
    const auto bounds = static_cast<std::size_t>(_playbacks[index].clip() + 1);
    const bool isPlain = !_controllers[index] && bounds < _clipBounds.size();
    return isPlain ? _clipBounds[bounds] : _allBounds;
}

CrowdMember CrowdInstances::memberOf(std::size_t index) const
{
    CrowdMember member(sphereAround(boxOf(index), _rootMatrices[index]));
    member.scale = _scales[index];
    if (_controllers[index] || proportionsOf(index))
        member.clip = CrowdMember::controlled;
    else
        _playbacks[index].describe(member);
    return member;
}

/// True if the instance has another box than before because of its poses.
bool CrowdInstances::updatePosedBox(std::size_t index)
{
    std::unique_ptr<PosedBox>& posed = _posedBoxes[index];
    const std::shared_ptr<const JointPose>& proportions = proportionsOf(index);
    const bool isPosed =
        _mixBounds && (proportions || (_controllers[index] && !_controllers[index]->instruction().poses.empty()));
    if (!isPosed && !posed) return false;
    if (!isPosed)
    {
        posed.reset();
        return true;
    }
    thread_local std::vector<PlayedClip> played;
    played.assign(1, PlayedClip{_playbacks[index].clip()});
    if (_controllers[index]) ControllerDetail::findPlayedClips(*_controllers[index], played);
    if (proportions) played.push_back({-1, PlayedClip::Part::Mixed, proportions->extent()});
    if (posed && posed->played == played) return false;
    posed = std::make_unique<PosedBox>(PosedBox{played, _mixBounds->box(played, anyConstraints(*_set))});
    return true;
}

Box CrowdInstances::bounds() const
{
    Aabb3d all;
    std::vector<PlayedClip> played;
    for (std::size_t index = 0; index < size(); ++index)
    {
        int clip = _playbacks[index].clip();
        bool isAlone = true;
        if (_controllers[index])
        {
            ControllerDetail::findPlayedClips(*_controllers[index], played);
            isAlone = played.size() == 1 && played.front().part == PlayedClip::Part::Mixed && !isConstrained(index);
            if (isAlone) clip = played.front().clip;
        }
        const auto place = static_cast<std::size_t>(clip + 1);
        const bool isOfClip = isAlone && !_posedBoxes[index] && place < _clipBounds.size();
        const Box& box = isOfClip ? _clipBounds[place] : boxOf(index);
        if (!box.empty()) all.add(TransformedBox(_rootMatrices[index], box).bounds(glm::dmat3(1.0), glm::dvec3(0.0)));
    }
    return all.empty() ? Box() : Box{glm::vec3(all.min), glm::vec3(all.max)};
}

CrowdInstances::Handle CrowdInstances::add(const AffineMatrix& rootMatrix, const osg::Vec3d& position,
                                           const AnimationController& controller, std::uint32_t tint)
{
    const std::size_t index = size();
    const bool isPlain = ControllerDetail::isPlainLoop(controller);
    _rootMatrices.add(rootMatrix);
    _positions.push_back(position);
    _scales.push_back(maxScale(rootMatrix));
    _tints.add(tint);
    _tinted += tint != PoseBatch::white;
    if (!_outfits.empty()) _outfits.push_back(0);
    _playbacks.push_back(isPlain ? CrowdPlayback(controller, _clock) : CrowdPlayback());
    _controllers.push_back(isPlain ? nullptr : std::make_unique<AnimationController>(controller));
    _posedBoxes.emplace_back();
    _handles.push_back(newHandle(index));
    updatePosedBox(index);
    _cells.add(memberOf(index));
    _isControlledKnown = _isControlledKnown && isPlain;
    listenTo(index);
    return _handles[index];
}

void CrowdInstances::remove(std::size_t index)
{
    const std::size_t place = placeOf(_handles[index]);
    _machines.erase(_handles[index]);
    _userData.erase(_handles[index]);
    ++_usesOfPlace[place];
    _freePlaces.push_back(static_cast<std::uint32_t>(place));
    _tinted -= _tints[index] != PoseBatch::white;
    _rootMatrices.remove(index);
    takeOut(_positions, index);
    _cells.remove(index);
    takeOut(_scales, index);
    _tints.remove(index);
    if (!_outfits.empty()) takeOut(_outfits, index);
    takeOut(_playbacks, index);
    takeOut(_controllers, index);
    takeOut(_posedBoxes, index);
    takeOut(_handles, index);
    _isControlledKnown = _isControlledKnown && _controlled.empty();
    if (index < size()) _indexOfPlace[placeOf(_handles[index])] = static_cast<std::uint32_t>(index);
}

void CrowdInstances::move(std::size_t index, const AffineMatrix& rootMatrix, const osg::Vec3d& position)
{
    ++_motions;
    _rootMatrices.set(index, rootMatrix);
    _positions[index] = position;
    _scales[index] = maxScale(rootMatrix);
    updateMember(index);
}

Result<void> CrowdInstances::setOrigin(const osg::Vec3d& origin)
{
    if (!std::isfinite(origin.length())) return Error{"the origin is not finite"};
    for (std::size_t index = 0; index < size(); ++index)
        if (!((_positions[index] - origin).length() < double(std::numeric_limits<float>::max())))
            return Error{"instance " + std::to_string(index) + " is too far from the origin for a float"};
    for (std::size_t index = 0; index < size(); ++index)
    {
        AffineMatrix root = _rootMatrices[index];
        for (int row = 0; row < 3; ++row)
            root.rows[static_cast<std::size_t>(row)].w = static_cast<float>(_positions[index][row] - origin[row]);
        move(index, root, _positions[index]);
    }
    return {};
}

void CrowdInstances::setTint(std::size_t index, std::uint32_t tint)
{
    _tinted -= _tints[index] != PoseBatch::white;
    _tints.set(index, tint);
    _tinted += tint != PoseBatch::white;
}

void CrowdInstances::setOutfit(std::size_t index, std::uint16_t outfit)
{
    if (_outfits.empty() && outfit == 0) return;
    _outfits.resize(size(), 0);
    const std::shared_ptr<const JointPose> before = proportionsOf(index);
    _outfits[index] = outfit;
    if (before != proportionsOf(index)) updateProportions(index);
}

void CrowdInstances::removeOutfit(std::uint16_t outfit)
{
    for (std::size_t index = 0; index < _outfits.size(); ++index)
        if (_outfits[index] == outfit) setOutfit(index, 0);
}

void CrowdInstances::setProportions(std::uint16_t outfit, std::shared_ptr<const JointPose> proportions)
{
    if (!proportions && outfit >= _proportions.size()) return;
    if (outfit >= _proportions.size()) _proportions.resize(outfit + 1u);
    _proportions[outfit] = std::move(proportions);
    for (std::size_t index = 0; index < _outfits.size(); ++index)
        if (_outfits[index] == outfit) updateProportions(index);
}

void CrowdInstances::updateProportions(std::size_t index)
{
    ++_motions;
    updatePosedBox(index);
    updateMember(index);
}

const std::shared_ptr<const JointPose>& CrowdInstances::proportionsOf(std::size_t index) const
{
    static const std::shared_ptr<const JointPose> none;
    return outfit(index) < _proportions.size() ? _proportions[outfit(index)] : none;
}

void CrowdInstances::setUserData(std::size_t index, osg::Referenced* data)
{
    if (data)
        _userData[_handles[index]] = data;
    else
        _userData.erase(_handles[index]);
}

osg::Referenced* CrowdInstances::userData(std::size_t index) const
{
    const auto found = _userData.find(_handles[index]);
    return found == _userData.end() ? nullptr : found->second.get();
}

PoseInstruction CrowdInstances::instruction(std::size_t index) const
{
    PoseInstruction instruction;
    if (_controllers[index])
        instruction = _controllers[index]->instruction();
    else
        instruction.samples[0] = _playbacks[index].sample(*_set, _clock);
    const std::shared_ptr<const JointPose>& proportions = proportionsOf(index);
    if (!proportions || instruction.sampleCount == PoseInstruction::maxSamples) return instruction;
    instruction.samples[instruction.sampleCount++] = {static_cast<std::uint32_t>(instruction.poses.size()), 0.0f, 1.0f,
                                                      POSE_SAMPLE_POSED | POSE_SAMPLE_ABOVE};
    instruction.poses.push_back(proportions);
    return instruction;
}

AnimationController& CrowdInstances::controller(std::size_t index)
{
    if (!_controllers[index])
    {
        _controllers[index] = std::make_unique<AnimationController>(_playbacks[index].controller(_set, _clock));
        _isControlledKnown = false;
        updateMember(index);
    }
    return *_controllers[index];
}

AnimationController CrowdInstances::controllerCopy(std::size_t index) const
{
    return _controllers[index] ? *_controllers[index] : _playbacks[index].controller(_set, _clock);
}

void CrowdInstances::setEventCallback(EventCallback callback)
{
    _eventCallback = callback ? std::make_shared<const EventCallback>(std::move(callback)) : nullptr;
    for (std::size_t index = 0; index < size(); ++index)
    {
        if (_controllers[index]) _controllers[index]->setEventCallback({});
        listenTo(index);
    }
}

/// Gives the instance a controller that calls the common callback.
void CrowdInstances::listenTo(std::size_t index)
{
    if (!_eventCallback) return;
    const std::weak_ptr<const EventCallback> listener = _eventCallback;
    const Handle handle = _handles[index];
    controller(index).setEventCallback(
        [listener, handle](const AnimationEvent& event)
        {
            if (const std::shared_ptr<const EventCallback> callback = listener.lock()) (*callback)(handle, event);
        });
}

void CrowdInstances::setStateMachine(std::size_t index, std::unique_ptr<StateMachine> machine)
{
    if (!machine)
        _machines.erase(_handles[index]);
    else
        _machines[_handles[index]] = std::move(machine);
}

StateMachine* CrowdInstances::stateMachine(std::size_t index)
{
    const auto found = _machines.find(_handles[index]);
    return found == _machines.end() ? nullptr : found->second.get();
}

bool CrowdInstances::advance(double seconds, PendingEvents& outEvents)
{
    for (const auto& [handle, machine] : _machines)
        machine->update(controller(indexOf(handle)), seconds);
    if (std::isfinite(seconds)) _clock += seconds;
    ++_motions;
    if (!_isControlledKnown)
    {
        _controlled.clear();
        for (std::size_t index = 0; index < _controllers.size(); ++index)
            if (_controllers[index]) _controlled.push_back(static_cast<std::uint32_t>(index));
        _isControlledKnown = true;
    }
    bool haveSpheresChanged = false;
    for (const std::uint32_t index : _controlled)
    {
        std::unique_ptr<AnimationController>& controller = _controllers[index];
        ControllerDetail::advance(*controller, seconds, outEvents);
        if (updatePosedBox(index))
        {
            updateMember(index);
            haveSpheresChanged = true;
        }
        if (!ControllerDetail::isPlainLoop(*controller) || _machines.count(_handles[index]) > 0) continue;
        _playbacks[index] = CrowdPlayback(*controller, _clock);
        controller.reset();
        _isControlledKnown = false;
        updateMember(index);
        haveSpheresChanged = true;
    }
    return haveSpheresChanged;
}

PoseBatch::BlendCost CrowdInstances::blendCost(std::size_t index) const
{
    if (proportionsOf(index)) return PoseBatch::BlendCost::Posed;
    return _controllers[index] ? PoseBatch::blendCostOf(_controllers[index]->instruction())
                               : PoseBatch::BlendCost::Plain;
}

void CrowdInstances::addTo(PoseBatch& batch, const std::uint32_t* indices, std::size_t count) const
{
    for (std::size_t place = 0; place < count; ++place)
    {
        const std::uint32_t index = indices[place];
        if (proportionsOf(index))
            batch.add(instruction(index), _rootMatrices[index]);
        else if (_controllers[index])
            batch.add(_controllers[index]->instruction(), _rootMatrices[index]);
        else
            batch.addSample(_playbacks[index].sample(*_set, _clock), _rootMatrices[index]);
    }
    if (_tinted == 0) return;
    for (std::size_t place = 0; place < count; ++place)
        batch.setTint(place, _tints[indices[place]]);
}

} // namespace osgGpuAnimation
