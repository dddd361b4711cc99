// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/animation/playback/PendingEvents.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/frame/crowd/CrowdCells.h>
#include <osgGpuAnimation/frame/crowd/CrowdPlayback.h>
#include <osgGpuAnimation/gpu/buffers/SharedBlocks.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <osg/ref_ptr>
#include <osg/Referenced>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// A tint in 32 bits: RGBA, 8 bits each, red lowest. Components are limited to [0, 1]; NaN counts as 0.
inline std::uint32_t toRgba(const osg::Vec4& color)
{
    std::uint32_t rgba = 0;
    for (int channel = 0; channel < 4; ++channel)
    {
        const float value = color[channel] > 0.0f ? std::min(color[channel], 1.0f) : 0.0f;
        rgba |= static_cast<std::uint32_t>(std::lround(value * 255.0f)) << 8 * channel;
    }
    return rgba;
}

inline osg::Vec4 toColor(std::uint32_t rgba)
{
    const auto channel = [rgba](int shift) { return static_cast<float>(rgba >> shift & 255u) / 255.0f; };
    return {channel(0), channel(8), channel(16), channel(24)};
}

/// The instances of an AnimatedCrowd as dense arrays, one array per property. A handle identifies an instance for its
/// lifetime; its index changes when other instances are removed.
class CrowdInstances
{
public:
    using Handle = std::uint64_t; ///< lower half: place in the index table; upper half: its number of earlier uses
    using EventCallback = std::function<void(Handle, const AnimationEvent&)>;

    /// set: null counts as an empty one.
    explicit CrowdInstances(std::shared_ptr<const AnimationSet> set) : _set(AnimationSet::orEmpty(std::move(set))) {}
    CrowdInstances(const CrowdInstances& other);
    CrowdInstances& operator=(const CrowdInstances&) = delete;

    const std::shared_ptr<const AnimationSet>& set() const { return _set; }
    void setSet(std::shared_ptr<const AnimationSet> set) { _set = std::move(set); } ///< only without instances
    std::size_t size() const { return _rootMatrices.size(); }
    static constexpr std::size_t none = ~std::size_t(0);
    std::size_t indexOf(Handle handle) const; ///< none: no such instance
    /// The error of a handle that indexOf() does not know.
    static Error noInstance() { return Error{"the crowd has no such instance (any more)"}; }
    Handle handleOf(std::size_t index) const { return _handles[index]; }

    /// clipBounds: the box of an instance in the rest pose, then one per clip, in the character's space. mixBounds: for
    /// instances with poses of the application or constraints; null: none.
    void setClipBounds(const std::vector<Box>& clipBounds, std::shared_ptr<const MixBounds> mixBounds = nullptr);

    /// rootMatrix: relative to the crowd's origin. position: the exact translation, in the crowd's space.
    Handle add(const AffineMatrix& rootMatrix, const osg::Vec3d& position, const AnimationController& controller,
               std::uint32_t tint);
    void remove(std::size_t index);
    void move(std::size_t index, const AffineMatrix& rootMatrix, const osg::Vec3d& position);
    /// Makes all root matrices relative to another origin; their exact positions stay. Errors, without a change: the
    /// origin is not finite; an instance is too far from it for a float.
    Result<void> setOrigin(const osg::Vec3d& origin);
    void setTint(std::size_t index, std::uint32_t tint);
    /// The number of an outfit, see OutfitLists; 0: none.
    void setOutfit(std::size_t index, std::uint16_t outfit);
    std::uint16_t outfit(std::size_t index) const { return _outfits.empty() ? std::uint16_t(0) : _outfits[index]; }
    void removeOutfit(std::uint16_t outfit); ///< its instances have none
    /// The scales of joints of the outfit's instances, which have poses of their own; null: those of the clips.
    void setProportions(std::uint16_t outfit, std::shared_ptr<const JointPose> proportions);
    bool hasProportions() const { return !_proportions.empty(); } ///< some outfit has had some
    /// The application's data of an instance; null: none.
    void setUserData(std::size_t index, osg::Referenced* data);
    osg::Referenced* userData(std::size_t index) const;

    const AffineMatrix& rootMatrix(std::size_t index) const { return _rootMatrices[index]; }
    const osg::Vec3d& position(std::size_t index) const { return _positions[index]; }
    /// Centre, radius; radius below 0: empty.
    const glm::vec4& sphere(std::size_t index) const { return _cells.sphere(index); }
    float scale(std::size_t index) const { return _scales[index]; } ///< the largest of its root matrix
    std::uint32_t tint(std::size_t index) const { return _tints[index]; }
    PoseInstruction instruction(std::size_t index) const;
    PoseBatch::BlendCost blendCost(std::size_t index) const; ///< of its instruction
    /// True if a constraint has an effect on it.
    bool isConstrained(std::size_t index) const
    {
        return _controllers[index] && !_controllers[index]->instruction().targets.empty();
    }
    /// Valid until the next advance(), which may replace it by a CrowdPlayback.
    AnimationController& controller(std::size_t index);
    AnimationController controllerCopy(std::size_t index) const;
    /// The box around the boxes of all instances, each of the clip that it plays; of all clips if it mixes several; of
    /// its mix if it has a JointPose.
    Box bounds() const;
    /// Without a controller there is none.
    RootMotion takeRootMotion(std::size_t index)
    {
        return _controllers[index] ? _controllers[index]->takeRootMotion() : RootMotion();
    }
    bool hasController(std::size_t index) const { return _controllers[index] != nullptr; }
    double clock() const { return _clock; } ///< seconds; see CrowdMember
    /// Grows with each advance() and move(): the same number, the same joints of instances without a controller.
    std::uint64_t motions() const { return _motions; }
    /// Identifies this object and no copy.
    const std::shared_ptr<const void>& identity() const { return _identity; }
    /// Snapshots for frames, by index. Tints: null if all are white.
    SharedBlocks<AffineMatrix>::Snapshot placements() const { return _rootMatrices.snapshot(); }
    SharedBlocks<std::uint32_t>::Snapshot tints() const
    {
        return _tinted > 0 ? _tints.snapshot() : SharedBlocks<std::uint32_t>::Snapshot();
    }

    /// Replaces the callbacks of all instances, and of those that are added later. Empty: removes them. Copies of this
    /// object do not copy it. All instances keep a controller as long as there is one.
    void setEventCallback(EventCallback callback);
    /// advance() updates the machine of an instance; the instance keeps a controller. Null: removes the machine.
    void setStateMachine(std::size_t index, std::unique_ptr<StateMachine> machine);
    /// Null: none. Valid until the instance or its machine is removed.
    StateMachine* stateMachine(std::size_t index);

    /// Advances all instances and appends their events. True if spheres have changed.
    bool advance(double seconds, PendingEvents& outEvents);

    /// See CrowdCells.
    void findSeen(const std::vector<glm::vec4>& planes, SeenMembers& outSeen) const
    {
        _cells.findSeen(planes, outSeen);
    }
    /// Adds the instances to the batch, in the order of the indices.
    void addTo(PoseBatch& batch, const std::uint32_t* indices, std::size_t count) const;

private:
    static std::size_t placeOf(Handle handle) { return handle & 0xFFFFFFFFu; } ///< in _indexOfPlace
    /// The box of an instance with a JointPose or proportions, in the character's space.
    struct PosedBox
    {
        std::vector<PlayedClip> played;
        Box box;
    };

    const Box& boxOf(std::size_t index) const;
    CrowdMember memberOf(std::size_t index) const;
    void updateMember(std::size_t index) { _cells.set(index, memberOf(index)); }
    bool updatePosedBox(std::size_t index);
    void updateProportions(std::size_t index);
    const std::shared_ptr<const JointPose>& proportionsOf(std::size_t index) const; ///< null: those of the clips
    void listenTo(std::size_t index);
    Handle newHandle(std::size_t index);

    std::shared_ptr<const AnimationSet> _set;
    double _clock = 0.0; ///< seconds
    std::uint64_t _motions = 0;
    std::vector<Box> _clipBounds;
    Box _allBounds; ///< of instances with a controller
    std::shared_ptr<const MixBounds> _mixBounds;
    SharedBlocks<AffineMatrix> _rootMatrices;
    std::vector<osg::Vec3d> _positions;
    CrowdCells _cells;
    std::vector<float> _scales;
    SharedBlocks<std::uint32_t> _tints;
    std::vector<std::uint16_t> _outfits;                        ///< empty: all have none
    std::vector<std::shared_ptr<const JointPose>> _proportions; ///< by outfit; may have fewer
    std::vector<CrowdPlayback> _playbacks;
    std::vector<std::unique_ptr<AnimationController>> _controllers; ///< mostly null
    std::vector<std::uint32_t> _controlled;                         ///< the indices of those that are not null
    bool _isControlledKnown = true;                                 ///< false: _controlled is out of date
    std::vector<std::unique_ptr<PosedBox>> _posedBoxes;             ///< null without a JointPose or proportions
    std::vector<Handle> _handles;
    std::vector<std::uint32_t> _indexOfPlace; ///< by the lower half of a handle
    std::vector<std::uint32_t> _usesOfPlace;
    std::vector<std::uint32_t> _freePlaces;
    std::size_t _tinted = 0; ///< instances that are not white
    std::shared_ptr<const void> _identity = std::make_shared<char>();
    std::shared_ptr<const EventCallback> _eventCallback;
    std::unordered_map<Handle, std::unique_ptr<StateMachine>> _machines;
    std::unordered_map<Handle, osg::ref_ptr<osg::Referenced>> _userData;
};

} // namespace osgGpuAnimation
