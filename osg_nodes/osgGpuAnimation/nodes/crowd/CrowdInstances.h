// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// What an instance of a crowd plays while it plays one clip in a loop: all that a controller has to say then
/// (AnimationController::isPlainLoop), in 24 bytes. Its time follows from the crowd's clock, so nothing has to be
/// advanced.
class CrowdPlayback
{
public:
    CrowdPlayback() = default; ///< shows the rest pose
    /// controller: a plain one. clock: the crowd's, in seconds.
    CrowdPlayback(const AnimationController& controller, double clock);

    int clip() const { return _clip; } ///< -1: none, the rest pose
    /// Seconds on the clip's time line, in [0, duration).
    double time(const AnimationSet& set, double clock) const;
    BlendSample sample(const AnimationSet& set, double clock) const { return set.sampleAt(_clip, time(set, clock)); }
    /// A controller in the same state.
    AnimationController controller(const std::shared_ptr<const AnimationSet>& set, double clock) const;

private:
    double _offset = 0.0; ///< clip seconds at clock 0; paused: at any
    double _speed = 1.0;
    int _clip = -1;
    bool _isPaused = false;
};

/// The instances of an AnimatedCrowd in flat arrays, one after another without gaps: those that a frame goes through
/// lie side by side. An instance is known outside by a handle that stays; its index changes when others are removed.
class CrowdInstances
{
public:
    using Handle = std::uint64_t; ///< place in the table of indices, and in the upper half how often it was used before

    explicit CrowdInstances(std::shared_ptr<const AnimationSet> set) : _set(std::move(set)) {}
    CrowdInstances(const CrowdInstances& other);
    CrowdInstances& operator=(const CrowdInstances&) = delete;

    const std::shared_ptr<const AnimationSet>& set() const { return _set; }
    void setSet(std::shared_ptr<const AnimationSet> set) { _set = std::move(set); } ///< while there are no instances
    std::size_t size() const { return _rootMatrices.size(); }
    static constexpr std::size_t none = ~std::size_t(0);
    std::size_t indexOf(Handle handle) const; ///< none where the handle names no instance (any more)
    Handle handleOf(std::size_t index) const { return _handles[index]; }

    /// The box that holds every vertex of an instance while it plays the clip: at clip + 1, the rest pose's first.
    void setClipBounds(const std::vector<Box>& clipBounds);

    Handle add(const AffineMatrix& rootMatrix, const AnimationController& controller, std::uint32_t tint);
    void remove(std::size_t index);
    void move(std::size_t index, const AffineMatrix& rootMatrix);
    void setTint(std::size_t index, std::uint32_t tint);

    const AffineMatrix& rootMatrix(std::size_t index) const { return _rootMatrices[index]; }
    const glm::vec4& sphere(std::size_t index) const { return _spheres[index]; } ///< centre, radius; negative: nothing
    std::uint32_t tint(std::size_t index) const { return _tints[index]; }
    PoseInstruction instruction(std::size_t index) const;
    PoseBatch::BlendCost load(std::size_t index) const; ///< of its instruction
    /// Holds until the next advance(), which takes it back where a CrowdPlayback will do.
    AnimationController& controller(std::size_t index);
    AnimationController controllerCopy(std::size_t index) const;
    /// Controllers there are, one for each instance that a CrowdPlayback will not do for.
    std::size_t controllerCount() const;

    /// Moves all times on. True where spheres have changed.
    bool advance(double seconds);

    /// Indices of the instances that have something on the inner side of all planes: n · p + d >= 0.
    void findSeen(const std::vector<glm::vec4>& planes, std::vector<std::uint32_t>& outIndices) const;
    /// Adds them, in that order.
    void addTo(PoseBatch& batch, const std::vector<std::uint32_t>& indices) const;

private:
    static std::size_t placeOf(Handle handle) { return handle & 0xFFFFFFFFu; } ///< in the table of indices
    glm::vec4 placedSphere(std::size_t index) const;
    Handle newHandle(std::size_t index);

    std::shared_ptr<const AnimationSet> _set;
    double _clock = 0.0; ///< seconds
    std::vector<Box> _clipBounds;
    Box _allBounds;
    std::vector<AffineMatrix> _rootMatrices;
    std::vector<glm::vec4> _spheres;
    std::vector<std::uint32_t> _tints;
    std::vector<CrowdPlayback> _playbacks;
    std::vector<std::unique_ptr<AnimationController>> _controllers; ///< mostly null
    std::vector<Handle> _handles;
    std::vector<std::uint32_t> _indexOfPlace; ///< by a handle's lower half
    std::vector<std::uint32_t> _usesOfPlace;
    std::vector<std::uint32_t> _freePlaces;
    std::size_t _tinted = 0; ///< instances that are not white
};

} // namespace osgGpuAnimation
