// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PoseFrame.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

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
    next->reset(frameNumber);
    return next;
}

void PoseFrame::reset(unsigned int frameNumber)
{
    _frameNumber = frameNumber;
    _batches.clear();
    _batchesOfSet.clear();
    _enlisted.clear();
    _statesUsed = 0;
}

osg::StateSet* PoseFrame::enlist(const AnimatedCharacter& character)
{
    const PoseInstruction& instruction = character.controller().instruction();
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto known = _enlisted.find(&character);
    if (known != _enlisted.end() && isSame(known->second.instruction, instruction)) return known->second.stateSet;

    Batch& batch = openBatch(character);
    osg::StateSet* stateSet = nextState(batch, batch.content.add(instruction));
    _enlisted[&character] = {instruction, stateSet};
    return stateSet;
}

PoseFrame::Batch& PoseFrame::openBatch(const AnimatedCharacter& character)
{
    std::vector<Batch*>& batches = _batchesOfSet[&character.set()];
    if (batches.empty() || batches.back()->isEvaluated)
    {
        _batches.push_back(
            std::make_unique<Batch>(Batch{PoseBatch(character.controller().sharedSet()), batches.size()}));
        batches.push_back(_batches.back().get());
    }
    return *batches.back();
}

osg::StateSet* PoseFrame::nextState(const Batch& batch, std::size_t instance)
{
    if (_statesUsed == _states.size())
    {
        _states.push_back(new osg::StateSet);
        _states.back()->setAttribute(new PaletteBinding);
    }
    osg::StateSet* stateSet = _states[_statesUsed++].get();
    auto* binding = static_cast<PaletteBinding*>(stateSet->getAttribute(PaletteBinding::bindingType));
    binding->set(batch.content.sharedSet(), batch.slot, instance);
    return stateSet;
}

void PoseFrame::evaluate(osg::RenderInfo& renderInfo)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::State& state = *renderInfo.getState();
    PosePipeline* pipeline = PosePipeline::of(state);
    for (const std::unique_ptr<Batch>& batch : _batches)
    {
        // A context made anew under an old one's number has none of its palettes.
        if (batch->isEvaluated && pipeline && pipeline->place(batch->content.set(), batch->slot, 0).texture != 0)
            continue;
        batch->isEvaluated = true;
        if (pipeline) pipeline->evaluate(state, batch->content, batch->slot);
    }
}

} // namespace osgGpuAnimation
