// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/stage/PoseFrame.h>

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/gpu/passes/FeedbackTimer.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <unordered_set>

namespace osgGpuAnimation
{

namespace
{

bool isSame(const BlendSample& a, const BlendSample& b)
{
    return a.keyframe == b.keyframe && a.alpha == b.alpha && a.weight == b.weight && a.control == b.control;
}

/// Adds, because several cameras may evaluate poses in one frame.
void addTo(osg::Stats& stats, unsigned int frameNumber, const char* attribute, double amount)
{
    double before = 0.0;
    stats.getAttribute(frameNumber, attribute, before);
    stats.setAttribute(frameNumber, attribute, before + amount);
}

PaletteBinding& bindingOf(osg::StateSet& stateSet)
{
    return static_cast<PaletteBinding&>(*stateSet.getAttribute(PaletteBinding::bindingType));
}

} // namespace

osg::ref_ptr<PoseFrame> PoseFrame::forContext(unsigned int contextId, const osg::FrameStamp* stamp)
{
    const unsigned int frameNumber = stamp ? stamp->getFrameNumber() : 0;
    const double referenceTime = stamp ? stamp->getReferenceTime() : 0.0;
    static std::mutex mutex;
    struct Context
    {
        std::vector<osg::ref_ptr<PoseFrame>> frames; ///< the latest last
        std::shared_ptr<std::atomic<std::size_t>> maxTexels =
            std::make_shared<std::atomic<std::size_t>>(std::numeric_limits<std::size_t>::max());
    };
    static std::unordered_map<unsigned int, Context> contexts;
    const std::lock_guard<std::mutex> lock(mutex);
    std::vector<osg::ref_ptr<PoseFrame>>& frames = contexts[contextId].frames;
    // The palettes of frames before the latest are overwritten.
    if (!frames.empty() && frames.back()->_frameNumber == frameNumber &&
        frames.back()->_referenceTime == referenceTime && (!stamp || frames.back()->_stamp.valid()))
        return frames.back();
    const auto unused = std::find_if(frames.begin(), frames.end(),
                                     [](const osg::ref_ptr<PoseFrame>& frame) { return frame->referenceCount() == 1; });
    osg::ref_ptr<PoseFrame> next = unused == frames.end() ? new PoseFrame : unused->get();
    if (unused != frames.end()) frames.erase(unused);
    frames.push_back(next);
    // Finished frames must not keep sets alive.
    for (const osg::ref_ptr<PoseFrame>& frame : frames)
        if (frame->referenceCount() == 1) frame->reset();
    next->reset();
    next->_frameNumber = frameNumber;
    next->_referenceTime = referenceTime;
    next->_stamp = stamp;
    next->_maxTexels = contexts[contextId].maxTexels;
    return next;
}

void PoseFrame::reset()
{
    for (const std::unique_ptr<Batch>& batch : _batches)
    {
        batch->content->reset(nullptr);
        _spareBatches.push_back(std::move(batch->content));
    }
    // Keep at most twice the batches of the last frame.
    _spareBatches.resize(std::min(_spareBatches.size(), 2 * _batches.size()));
    _batches.clear();
    _batchesOfSet.clear();
    _submitted.clear();
    _samples.clear();
    _targets.clear();
    _shared.clear();
    for (auto& pools : _states)
        for (StatePool& pool : pools)
            pool.reset();
}

SubmittedPose PoseFrame::submit(const osg::Node& node, const AnimationController& controller,
                                const AffineMatrix& rootMatrix)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Submitted& submitted = _submitted[&node];
    if (!hasSameInstruction(submitted, controller, rootMatrix))
    {
        const PoseInstruction& instruction = controller.instruction();
        Batch& batch = openBatch(controller, rootMatrix);
        submitted = {&batch,          batch.content->add(instruction), _samples.size(), instruction.sampleCount,
                     _targets.size(), instruction.targets.size(),      nullptr};
        _targets.insert(_targets.end(), instruction.targets.begin(), instruction.targets.end());
        _samples.insert(_samples.end(), instruction.samples.begin(),
                        instruction.samples.begin() + static_cast<std::ptrdiff_t>(instruction.sampleCount));
    }
    return {submitted.batch->slot, submitted.instance};
}

// Another viewer's frame with the same number may have a different node at the same address.
bool PoseFrame::hasSameInstruction(const Submitted& known, const AnimationController& controller,
                                   const AffineMatrix& rootMatrix) const
{
    const PoseInstruction& instruction = controller.instruction();
    return known.batch && &known.batch->content->set() == &controller.set() &&
           known.batch->content->hasRootMatrix(rootMatrix) &&
           known.batch->content->hasPoses(known.instance, instruction) &&
           known.sampleCount == instruction.sampleCount &&
           std::equal(instruction.samples.begin(),
                      instruction.samples.begin() + static_cast<std::ptrdiff_t>(instruction.sampleCount),
                      _samples.begin() + static_cast<std::ptrdiff_t>(known.firstSample), isSame) &&
           known.targetCount == instruction.targets.size() &&
           (known.targetCount == 0 || std::memcmp(_targets.data() + known.firstTarget, instruction.targets.data(),
                                                  known.targetCount * sizeof(ConstraintTarget)) == 0);
}

osg::StateSet* PoseFrame::stateOf(const osg::Node& node, const AnimationSet& set, SubmittedPose pose, int level)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Submitted& submitted = _submitted[&node];
    // A concurrent camera may have submitted the node with another instruction.
    const bool isOther = submitted.batch->slot != pose.slot || submitted.instance != pose.instance;
    if (isOther) return stateOf(*_batchesOfSet[&set][pose.slot], pose.instance, 1, level).stateSet;
    if (level != LodLevels::allTriangles) return stateOf(*submitted.batch, submitted.instance, 1, level).stateSet;
    if (!submitted.stateSet) submitted.stateSet = stateOf(*submitted.batch, submitted.instance, 1, level).stateSet;
    return submitted.stateSet;
}

PoseFrame::Batch& PoseFrame::openBatch(const AnimationController& controller, const AffineMatrix& rootMatrix)
{
    std::vector<Batch*>& batches = _batchesOfSet[&controller.set()];
    const PoseInstruction& instruction = controller.instruction();
    const auto open = std::find_if(batches.begin(), batches.end(),
                                   [&](const Batch* batch)
                                   {
                                       return !batch->isWhole && !batch->isEvaluated &&
                                              batch->content->hasRootMatrix(rootMatrix) &&
                                              batch->content->accepts(instruction);
                                   });
    if (open != batches.end()) return **open;
    std::unique_ptr<PoseBatch> content = spareBatch(controller.sharedSet());
    content->setRootMatrix(rootMatrix);
    return addBatch(std::move(content));
}

PoseFrame::Batch& PoseFrame::addBatch(std::unique_ptr<PoseBatch> content)
{
    std::vector<Batch*>& batches = _batchesOfSet[&content->set()];
    _batches.push_back(std::make_unique<Batch>(Batch{std::move(content), batches.size()}));
    batches.push_back(_batches.back().get());
    return *batches.back();
}

std::unique_ptr<PoseBatch> PoseFrame::spareBatch(std::shared_ptr<const AnimationSet> set)
{
    if (_spareBatches.empty()) return std::make_unique<PoseBatch>(std::move(set));
    std::unique_ptr<PoseBatch> batch = std::move(_spareBatches.back());
    _spareBatches.pop_back();
    batch->reset(std::move(set));
    return batch;
}

std::unique_ptr<PoseBatch> PoseFrame::makeBatch(std::shared_ptr<const AnimationSet> set)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return spareBatch(std::move(set));
}

/// The batch of a crowd with this content: that of another camera, or a new one.
PoseFrame::Batch& PoseFrame::wholeBatch(std::unique_ptr<PoseBatch> content)
{
    for (Batch* batch : _batchesOfSet[&content->set()])
        if (batch->isWhole && batch->content->isSame(*content))
        {
            _spareBatches.push_back(std::move(content));
            return *batch;
        }
    Batch& batch = addBatch(std::move(content));
    batch.isWhole = true;
    return batch;
}

std::size_t PoseFrame::submit(std::unique_ptr<PoseBatch> content, const void* crowd,
                              const std::vector<std::uint32_t>& instances)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Batch& batch = wholeBatch(std::move(content));
    if (!batch.crowd)
    {
        batch.crowd = crowd;
        batch.instances = instances;
    }
    return batch.slot;
}

std::size_t PoseFrame::submitShared(std::unique_ptr<PoseBatch> content, const void* crowd,
                                    std::shared_ptr<const PlacedInstances> placed)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _shared.push_back({crowd, content->sharedSet(), std::move(placed)});
    return wholeBatch(std::move(content)).slot;
}

DrawState PoseFrame::placedState(const AnimationSet& set, std::size_t slot,
                                 const std::shared_ptr<const PlacedInstances>& placed, std::size_t first,
                                 std::size_t count, int level)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const PoseBatch& batch = *_batchesOfSet[&set][slot]->content;
    const bool isShared = placed->placements != nullptr;
    const DrawState state = nextState(isShared ? OfSharedPoses : OfListedPoses,
                                      isShared ? placed->tints != nullptr : !batch.tints().empty());
    state.binding->setPlaced(batch.sharedSet(), slot, placed, first, count);
    state.binding->setLevel(level);
    return state;
}

DrawState PoseFrame::stateOf(const Batch& batch, std::size_t instance, std::size_t instanceCount, int level)
{
    const DrawState state = nextState(OfPalette, !batch.content->tints().empty());
    state.binding->set(batch.content->sharedSet(), batch.slot, instance, instanceCount);
    state.binding->setLevel(level);
    return state;
}

DrawState PoseFrame::partState(const AnimationSet& set, std::size_t slot, std::size_t first, std::size_t count,
                               int level)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return stateOf(*_batchesOfSet[&set][slot], first, count, level);
}

DrawState PoseFrame::instancedState(const AnimationSet& set, std::size_t slot, int level)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const DrawState state = nextState(OfTransforms, false);
    state.binding->setInstanced(_batchesOfSet[&set][slot]->content->sharedSet(), slot);
    state.binding->setLevel(level);
    return state;
}

DrawState PoseFrame::nextState(Placements placements, bool isTinted)
{
    StatePool& pool = _states[placements][isTinted ? 1 : 0];
    if (pool.used == pool.states.size())
    {
        pool.states.push_back(new osg::StateSet);
        pool.states.back()->setAttribute(new PaletteBinding);
        if (placements == OfTransforms) pool.states.back()->setDefine("POSE_INSTANCED");
        if (placements == OfSharedPoses) pool.states.back()->setDefine("POSE_PLACED");
        if (placements == OfListedPoses) pool.states.back()->setDefine("POSE_LISTED");
        if (isTinted) pool.states.back()->setDefine("POSE_TINTED");
    }
    osg::StateSet& state = *pool.states[pool.used++];
    return {&state, &bindingOf(state)};
}

void PoseFrame::StatePool::reset()
{
    // Keep at most twice the states of the last frame.
    states.resize(std::min(states.size(), 2 * used));
    for (const osg::ref_ptr<osg::StateSet>& state : states)
        bindingOf(*state).set(nullptr, 0, 0, 0);
    used = 0;
}

void PoseFrame::evaluate(osg::State& state, osg::Stats* stats)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    PosePipeline* pipeline = PosePipeline::of(state);
    if (pipeline) *_maxTexels = pipeline->getMaxTexels();
    if (!stats || !pipeline) return evaluateBatches(state, pipeline);
    FeedbackTimer& timer = FeedbackTimer::of(state);
    const std::uint64_t evaluatedBefore = pipeline->getCounters().instancesEvaluated;
    timer.begin();
    evaluateBatches(state, pipeline);
    timer.end(_frameNumber);
    record(*stats, pipeline->getCounters().instancesEvaluated - evaluatedBefore);
    for (const FeedbackTimer::Measured& measured : timer.takeFinished())
        addTo(*stats, measured.frameNumber, PoseStatistics::timeTaken, measured.seconds);
}

void PoseFrame::evaluateBatches(osg::State& state, PosePipeline* pipeline)
{
    for (const std::unique_ptr<Batch>& batch : _batches)
    {
        // A new context that reuses the number of an old one has no palettes.
        if (batch->isEvaluated && pipeline && pipeline->place(batch->content->set(), batch->slot, 0).texture != 0)
            continue;
        batch->isEvaluated = true;
        if (pipeline) pipeline->evaluate(state, *batch->content, batch->slot);
    }
}

void PoseFrame::record(osg::Stats& stats, std::uint64_t evaluated) const
{
    // Several cameras and batches may have the same characters.
    std::size_t seen = _submitted.size(), joints = 0;
    for (const auto& [node, submitted] : _submitted)
        joints += submitted.batch->content->set().skeleton().jointCount();
    std::unordered_map<const void*, std::unordered_set<std::uint32_t>> seenOfCrowds;
    const auto count = [&](const void* crowd, std::uint32_t instance, const AnimationSet& set)
    {
        if (!seenOfCrowds[crowd].insert(instance).second) return;
        ++seen;
        joints += set.skeleton().jointCount();
    };
    for (const std::unique_ptr<Batch>& batch : _batches)
        for (const std::uint32_t instance : batch->instances)
            count(batch->crowd, instance, batch->content->set());
    for (const Shared& shared : _shared)
        for (const PlacedInstances::Drawn& drawn : shared.placed->drawn)
            count(shared.crowd, drawn.index(), *shared.set);
    stats.setAttribute(_frameNumber, PoseStatistics::charactersSeen, static_cast<double>(seen));
    stats.setAttribute(_frameNumber, PoseStatistics::jointsSeen, static_cast<double>(joints));
    addTo(stats, _frameNumber, PoseStatistics::charactersEvaluated, static_cast<double>(evaluated));
}

} // namespace osgGpuAnimation
