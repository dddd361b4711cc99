// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PoseFrame.h>

#include <osgGpuAnimation/gpu/FeedbackTimer.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/PoseStatistics.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

bool isSame(const PoseInstruction& a, const PoseInstruction& b)
{
    const auto same = [](const BlendSample& left, const BlendSample& right)
    {
        return left.keyframe == right.keyframe && left.alpha == right.alpha && left.weight == right.weight &&
               left.control == right.control;
    };
    return a.sampleCount == b.sampleCount &&
           std::equal(a.samples.begin(), a.samples.begin() + a.sampleCount, b.samples.begin(), same);
}

/// Several cameras may have poses evaluated in one frame.
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

osg::ref_ptr<PoseFrame> PoseFrame::forContext(unsigned int contextId, unsigned int frameNumber)
{
    static std::mutex mutex;
    static std::unordered_map<unsigned int, std::vector<osg::ref_ptr<PoseFrame>>> framesOfContext; // the latest last
    const std::lock_guard<std::mutex> lock(mutex);
    std::vector<osg::ref_ptr<PoseFrame>>& frames = framesOfContext[contextId];
    // Of frames before the latest, the palettes have been written over.
    if (!frames.empty() && frames.back()->frameNumber() == frameNumber) return frames.back();
    const auto unused = std::find_if(frames.begin(), frames.end(),
                                     [](const osg::ref_ptr<PoseFrame>& frame) { return frame->referenceCount() == 1; });
    osg::ref_ptr<PoseFrame> next = unused == frames.end() ? new PoseFrame : unused->get();
    if (unused != frames.end()) frames.erase(unused);
    frames.push_back(next);
    // Frames that are over keep no sets alive.
    for (const osg::ref_ptr<PoseFrame>& frame : frames)
        if (frame->referenceCount() == 1) frame->reset(frame->frameNumber());
    next->reset(frameNumber);
    return next;
}

void PoseFrame::reset(unsigned int frameNumber)
{
    _frameNumber = frameNumber;
    for (const std::unique_ptr<Batch>& batch : _batches)
    {
        batch->content->reset(nullptr);
        _spareBatches.push_back(std::move(batch->content));
    }
    // As many again as were in use, and no more, wait for the next frame.
    _spareBatches.resize(std::min(_spareBatches.size(), 2 * _batches.size()));
    _batches.clear();
    _batchesOfSet.clear();
    _enlisted.clear();
    for (std::size_t i = 0; i < _statesUsed; ++i)
        bindingOf(*_states[i]).set(nullptr, 0, 0, 0);
    _statesUsed = 0;
}

osg::StateSet* PoseFrame::enlist(const AnimatedCharacter& character)
{
    const PoseInstruction& instruction = character.controller().instruction();
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto known = _enlisted.find(&character);
    // The address may be that of another character by now, in a viewer whose frames have the same numbers.
    if (known != _enlisted.end() && isSame(known->second.instruction, instruction) &&
        bindingOf(*known->second.stateSet).animationSet() == &character.set())
        return known->second.stateSet;

    Batch& batch = openBatch(character);
    osg::StateSet* stateSet = nextState(batch, batch.content->add(instruction), 1);
    _enlisted[&character] = {instruction, stateSet};
    return stateSet;
}

PoseFrame::Batch& PoseFrame::openBatch(const AnimatedCharacter& character)
{
    std::vector<Batch*>& batches = _batchesOfSet[&character.set()];
    const auto open = std::find_if(batches.begin(), batches.end(), [](const Batch* batch) { return batch->isOpen(); });
    return open != batches.end() ? **open : addBatch(spareBatch(character.controller().sharedSet()));
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

osg::StateSet* PoseFrame::enlist(std::unique_ptr<PoseBatch> content)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const Batch* batch : _batchesOfSet[&content->set()])
        if (batch->stateOfAll && batch->content->isSame(*content))
        {
            _spareBatches.push_back(std::move(content));
            return batch->stateOfAll;
        }
    Batch& batch = addBatch(std::move(content));
    batch.stateOfAll = nextState(batch, 0, batch.content->size());
    return batch.stateOfAll;
}

osg::StateSet* PoseFrame::nextState(const Batch& batch, std::size_t instance, std::size_t instanceCount)
{
    if (_statesUsed == _states.size())
    {
        _states.push_back(new osg::StateSet);
        _states.back()->setAttribute(new PaletteBinding);
    }
    osg::StateSet* stateSet = _states[_statesUsed++].get();
    bindingOf(*stateSet).set(batch.content->sharedSet(), batch.slot, instance, instanceCount);
    return stateSet;
}

void PoseFrame::evaluate(osg::RenderInfo& renderInfo, osg::Stats* stats)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::State& state = *renderInfo.getState();
    PosePipeline* pipeline = PosePipeline::of(state);
    if (!stats || !pipeline)
    {
        evaluateBatches(state, pipeline);
        return;
    }
    FeedbackTimer& timer = FeedbackTimer::of(state);
    const std::uint64_t evaluatedBefore = pipeline->counters().instancesEvaluated;
    timer.begin();
    evaluateBatches(state, pipeline);
    timer.end(_frameNumber);
    record(*stats, pipeline->counters().instancesEvaluated - evaluatedBefore);
    for (const FeedbackTimer::Measured& measured : timer.takeFinished())
        addTo(*stats, measured.frameNumber, PoseStatistics::timeTaken, measured.seconds);
}

void PoseFrame::evaluateBatches(osg::State& state, PosePipeline* pipeline)
{
    for (const std::unique_ptr<Batch>& batch : _batches)
    {
        // A context made anew under an old one's number has none of its palettes.
        if (batch->isEvaluated && pipeline && pipeline->place(batch->content->set(), batch->slot, 0).texture != 0)
            continue;
        batch->isEvaluated = true;
        if (pipeline) pipeline->evaluate(state, *batch->content, batch->slot);
    }
}

void PoseFrame::record(osg::Stats& stats, std::uint64_t evaluated) const
{
    std::size_t seen = 0, joints = 0;
    for (const std::unique_ptr<Batch>& batch : _batches)
    {
        seen += batch->content->size();
        joints += batch->content->size() * batch->content->set().skeleton().jointCount();
    }
    stats.setAttribute(_frameNumber, PoseStatistics::charactersSeen, static_cast<double>(seen));
    stats.setAttribute(_frameNumber, PoseStatistics::jointsSeen, static_cast<double>(joints));
    addTo(stats, _frameNumber, PoseStatistics::charactersEvaluated, static_cast<double>(evaluated));
}

} // namespace osgGpuAnimation
