// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/frame/PaletteBinding.h>

#include <osg/FrameStamp>
#include <osg/Node>
#include <osg/observer_ptr>
#include <osg/Referenced>
#include <osg/State>
#include <osg/StateSet>
#include <osg/Stats>

#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// Where a frame has a character's pose: an instance of the batch of that slot.
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
};

/// Where a frame has a batch that was submitted whole.
struct SubmittedBatch
{
    std::size_t slot;
    DrawState all; ///< for drawing all its instances
};

/// All characters that are seen in one frame in one graphics context, each once, however many cameras see it: the
/// batches they make up, and the state each is to be drawn with. Filled while cameras cull, maybe several at once;
/// evaluated on the draw side. It is a snapshot: the next frame's update may change the controllers meanwhile.
class PoseFrame : public osg::Referenced
{
public:
    /// The frame to fill now; frames still in use elsewhere are left alone. stamp: number and reference time say which
    /// frame it is, since another viewer's may have the same number; null: frame 0.
    static osg::ref_ptr<PoseFrame> forContext(unsigned int contextId, const osg::FrameStamp* stamp);

    /// Adds the pose of a node's controller, unless the node is already in with the same instruction.
    SubmittedPose submit(const osg::Node& node, const AnimationController& controller);
    /// The state for drawing the submitted node as it is, at a level of detail: it holds its PaletteBinding and
    /// stays unchanged while this frame is in use.
    osg::StateSet* stateOf(const osg::Node& node, const AnimationSet& set, SubmittedPose pose, int level);
    /// A new state for drawing instances of that batch together; the caller gives the binding their placements.
    DrawState placedState(const AnimationSet& set, std::size_t slot, int level);
    /// A new state for drawing so many instances of that batch, from the first on.
    DrawState partState(const AnimationSet& set, std::size_t slot, std::size_t first, std::size_t count, int level);

    /// An empty batch, to be filled by the caller alone and submitted; its storage is that of earlier frames.
    std::unique_ptr<PoseBatch> makeBatch(std::shared_ptr<const AnimationSet> set);
    /// Takes a whole batch up, unless the same is in already (several cameras may see the same). batch: not empty.
    SubmittedBatch submit(std::unique_ptr<PoseBatch> batch);

    /// Evaluates what was submitted and not evaluated yet. stats: where to record what there was to do, see
    /// PoseStatistics; null: nowhere.
    void evaluate(osg::State& state, osg::Stats* stats);

    unsigned int frameNumber() const { return _frameNumber; }

protected:
    ~PoseFrame() override = default;

private:
    struct Batch
    {
        std::unique_ptr<PoseBatch> content;
        std::size_t slot;
        DrawState all{}; ///< null: a batch of characters, which have states of their own
        bool isEvaluated = false;

        bool isOpen() const { return !all.stateSet && !isEvaluated; }
    };
    struct Submitted
    {
        const Batch* batch;
        std::size_t instance;
        std::size_t firstSample; ///< of its instruction's, in _samples
        std::size_t sampleCount;
        osg::StateSet* stateSet; ///< null: not asked for yet
    };
    /// States that are used again from frame to frame.
    struct StatePool
    {
        const char* define; ///< for the program; null: none
        std::vector<osg::ref_ptr<osg::StateSet>> states;
        std::size_t used = 0;

        DrawState next();
        void reset();
    };

    void reset();
    void evaluateBatches(osg::State& state, PosePipeline* pipeline);
    void record(osg::Stats& stats, std::uint64_t evaluated) const;
    bool isStill(const Submitted& known, const AnimationController& controller) const;
    Batch& openBatch(const AnimationController& controller);
    Batch& addBatch(std::unique_ptr<PoseBatch> content);
    std::unique_ptr<PoseBatch> spareBatch(std::shared_ptr<const AnimationSet> set);
    DrawState stateOf(const Batch& batch, std::size_t instance, std::size_t instanceCount, int level);

    std::mutex _mutex;
    unsigned int _frameNumber = 0;
    double _referenceTime = 0.0;                     ///< seconds
    osg::observer_ptr<const osg::FrameStamp> _stamp; ///< gone with its viewer; first frames' times are often equal
    std::vector<std::unique_ptr<Batch>> _batches;
    std::unordered_map<const AnimationSet*, std::vector<Batch*>> _batchesOfSet; ///< open ones: of several loads
    std::vector<std::unique_ptr<PoseBatch>> _spareBatches;
    std::unordered_map<const osg::Node*, Submitted> _submitted;
    std::vector<BlendSample> _samples; ///< of those submitted
    StatePool _plainStates{nullptr, {}, 0};
    StatePool _tintedStates{"POSE_TINTED", {}, 0};
    StatePool _placedStates{"POSE_PLACED", {}, 0}; ///< characters have no tints
};

} // namespace osgGpuAnimation
