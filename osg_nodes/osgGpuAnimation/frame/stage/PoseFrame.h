// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>

#include <osg/FrameStamp>
#include <osg/Node>
#include <osg/observer_ptr>
#include <osg/Referenced>
#include <osg/State>
#include <osg/StateSet>
#include <osg/Stats>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// The place of a character's pose in a frame: an instance of the batch in that slot.
struct SubmittedPose
{
    std::size_t slot = 0;
    std::size_t instance = 0;
};

/// The frame's state for drawing instances of a batch, and its binding.
struct DrawState
{
    osg::StateSet* stateSet;
    PaletteBinding* binding;
    std::size_t list = 0; ///< of a crowd: the meshes to draw, see OutfitLists
};

/// The visible characters of one frame in one graphics context, each once for all cameras: their batches and the states
/// to draw them with. Cameras fill it during cull, possibly several concurrently; the draw side evaluates it. It is a
/// snapshot: the update of the next frame may change the controllers at the same time.
class PoseFrame : public osg::Referenced
{
public:
    /// The frame to fill; frames that are still in use stay unchanged. stamp: its number and reference time identify
    /// the frame, because two viewers may use the same number; null: frame 0.
    static osg::ref_ptr<PoseFrame> forContext(unsigned int contextId, const osg::FrameStamp* stamp);

    /// Adds the pose of a node's controller unless the frame already has the node with the same instruction and root
    /// matrix.
    SubmittedPose submit(const osg::Node& node, const AnimationController& controller, const AffineMatrix& rootMatrix);
    /// The state with the PaletteBinding for one submitted node at a level of detail. It stays unchanged while this
    /// frame is in use.
    osg::StateSet* stateOf(const osg::Node& node, const AnimationSet& set, SubmittedPose pose, int level);
    /// A new state for an instanced draw of several characters; the caller adds their placements to the binding.
    DrawState instancedState(const AnimationSet& set, std::size_t slot, int level);
    /// A new state for `count` instances of the batch, starting at `first`.
    DrawState partState(const AnimationSet& set, std::size_t slot, std::size_t first, std::size_t count, int level);

    /// An empty batch for the caller to fill and submit. It reuses the storage of earlier frames.
    std::unique_ptr<PoseBatch> makeBatch(std::shared_ptr<const AnimationSet> set);
    /// Adds a whole batch unless an equal one was submitted (by another camera). batch: not empty. instances: their
    /// numbers in the crowd, for the statistics. Returns its slot.
    std::size_t submit(std::unique_ptr<PoseBatch> batch, const void* crowd,
                       const std::vector<std::uint32_t>& instances);

    /// Adds a batch of poses for the instances of a list, unless an equal one was submitted. Returns its slot.
    std::size_t submitShared(std::unique_ptr<PoseBatch> batch, const void* crowd,
                             std::shared_ptr<const PlacedInstances> placed);
    /// A new state for [first, first + count) of the instances of a list, with the poses of that slot.
    DrawState placedState(const AnimationSet& set, std::size_t slot,
                          const std::shared_ptr<const PlacedInstances>& placed, std::size_t first, std::size_t count,
                          int level);
    /// The largest buffer texture of the context, in texels; before the first evaluate() in the context it is unknown
    /// and counts as unlimited.
    std::size_t getMaxTexels() const { return *_maxTexels; }

    /// Evaluates the submitted batches that were not evaluated before. stats: receives the attributes of
    /// PoseStatistics; null: records nothing.
    void evaluate(osg::State& state, osg::Stats* stats);

    unsigned int getFrameNumber() const { return _frameNumber; }

protected:
    ~PoseFrame() override = default;

private:
    struct Batch
    {
        std::unique_ptr<PoseBatch> content;
        std::size_t slot;
        const void* crowd = nullptr;
        std::vector<std::uint32_t> instances{}; ///< of the crowd
        bool isEvaluated = false;
        bool isWhole = false; ///< of a crowd
    };
    struct Submitted
    {
        const Batch* batch;
        std::size_t instance;
        std::size_t firstSample; ///< of its instruction, in _samples
        std::size_t sampleCount;
        std::size_t firstTarget; ///< of its constraints, in _targets
        std::size_t targetCount;
        osg::StateSet* stateSet; ///< null: not created yet
    };
    /// The instances of a list, for the statistics.
    struct Shared
    {
        const void* crowd;
        std::shared_ptr<const AnimationSet> set;
        std::shared_ptr<const PlacedInstances> placed;
    };
    /// States that frames reuse.
    struct StatePool
    {
        std::vector<osg::ref_ptr<osg::StateSet>> states;
        std::size_t used = 0;

        void reset();
    };

    void reset();
    void evaluateBatches(osg::State& state, PosePipeline* pipeline);
    void record(osg::Stats& stats, std::uint64_t evaluated) const;
    bool hasSameInstruction(const Submitted& known, const AnimationController& controller,
                            const AffineMatrix& rootMatrix) const;
    Batch& openBatch(const AnimationController& controller, const AffineMatrix& rootMatrix);
    Batch& addBatch(std::unique_ptr<PoseBatch> content);
    Batch& wholeBatch(std::unique_ptr<PoseBatch> content);
    std::unique_ptr<PoseBatch> spareBatch(std::shared_ptr<const AnimationSet> set);
    DrawState stateOf(const Batch& batch, std::size_t instance, std::size_t instanceCount, int level);
    /// Where the placements of a draw come from.
    enum Placements
    {
        OfPalette,
        OfTransforms, ///< of characters, which have no tints
        OfSharedPoses,
        OfListedPoses, ///< of the palette, in the order of a list
    };
    DrawState nextState(Placements placements, bool isTinted);

    std::mutex _mutex;
    unsigned int _frameNumber = 0;
    double _referenceTime = 0.0;                     ///< seconds
    osg::observer_ptr<const osg::FrameStamp> _stamp; ///< tells viewers apart whose first frames have equal times
    std::vector<std::unique_ptr<Batch>> _batches;
    std::unordered_map<const AnimationSet*, std::vector<Batch*>>
        _batchesOfSet; ///< several may be open, with different blend costs
    std::vector<std::unique_ptr<PoseBatch>> _spareBatches;
    std::unordered_map<const osg::Node*, Submitted> _submitted;
    std::vector<BlendSample> _samples;      ///< of the submitted instructions
    std::vector<ConstraintTarget> _targets; ///< of the submitted instructions
    std::vector<Shared> _shared;
    std::shared_ptr<std::atomic<std::size_t>> _maxTexels; ///< the context's
    std::array<std::array<StatePool, 2>, 4> _states;      ///< by the arguments of nextState()
};

} // namespace osgGpuAnimation
