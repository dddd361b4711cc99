// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>

#include <osgGpuAnimation/animation/constraints/ConstraintGoals.h>

#include <algorithm>

namespace osgGpuAnimation
{

bool ControllerDetail::isPlainLoop(const AnimationController& controller)
{
    const bool isAlone = controller.layerCount() == 1 && !controller._eventCallback && !controller._rootMotionCurve;
    if (!isAlone || (controller._goals && !controller._goals->isDefault())) return false;
    const AnimationLayer& layer = controller._base;
    const AnimationLayer::Settings& settings = layer._settings;
    const bool isDefault = settings.mode == AnimationLayer::Mode::Override &&
                           settings.reference == AnimationLayer::Reference::RestPose && settings.blendPriority == 0 &&
                           settings.loopMode == LoopMode::Loop && settings.parameter == glm::dvec2(0.0) &&
                           !settings.isPhaseShared && !layer._mask && !layer._pose;
    if (!isDefault || !layer._weight.isFinished() || layer._weight.value() != 1.0) return false;
    const ClipPlayback& playback = layer.playback();
    if (layer._mixer.isEmpty()) return layer._state == PlayState::Stopped;
    return (layer._state == PlayState::Playing || layer._state == PlayState::Paused) && !layer._mixer.isFading() &&
           !layer._mixer.currentSpace() && playback.loopMode() == LoopMode::Loop && playback.speed() == settings.speed;
}

namespace
{

bool isAdditive(const AnimationLayer& layer)
{
    return layer.settings().mode == AnimationLayer::Mode::Additive;
}

/// Adds a clip unless `times` equal ones are in the list already.
void addUpTo(std::ptrdiff_t times, const PlayedClip& clip, std::vector<PlayedClip>& out)
{
    if (std::count(out.begin(), out.end(), clip) < times) out.push_back(clip);
}

/// True if the layer hides everything below it.
bool coversAll(const AnimationLayer& layer)
{
    if (isAdditive(layer) || ControllerDetail::maskNumber(layer) != 0 || layer.weight() < 1.0f) return false;
    if (layer.state() == PlayState::Stopped || layer.poseShare() > 0.0f) return false;
    double shares = 0.0;
    for (std::size_t v = 0; v < layer.mixer().activeClipCount(); ++v)
        shares += layer.mixer().activeClip(v).share;
    return shares > 1.0 - 1e-6;
}

// A clip that fades into itself occurs twice: a mix of two of its times can be a pose that the clip never shows.
void addActiveClips(const AnimationLayer& layer, std::vector<PlayedClip>& out)
{
    if (layer.poseShare() > 0.0f)
        out.push_back({-1, isAdditive(layer) ? PlayedClip::Part::AddedToRest : PlayedClip::Part::Mixed,
                       ControllerDetail::poseOf(layer)->extent()});
    if (layer.state() == PlayState::Stopped) return;
    for (std::size_t v = 0; v < layer.mixer().activeClipCount(); ++v)
    {
        const int clip = layer.mixer().activeClip(v).playback.clip();
        if (!isAdditive(layer))
            addUpTo(2, {clip, PlayedClip::Part::Mixed}, out);
        else if (layer.settings().reference == AnimationLayer::Reference::RestPose)
            out.push_back({clip, PlayedClip::Part::AddedToRest});
        else
            out.push_back({clip, PlayedClip::Part::AddedToItsFirst});
    }
}

} // namespace

void ControllerDetail::findPlayedClips(const AnimationController& controller, std::vector<PlayedClip>& out)
{
    out.clear();
    bool isRestHidden = false;
    std::size_t samples = 0; // see BlendList
    for (std::size_t i = 0; i < controller.layerCount(); ++i)
    {
        const AnimationLayer& layer = controller.layer(i);
        if (!(layer.weight() > 0.0f)) continue;
        isRestHidden = isRestHidden || coversAll(layer);
        const std::size_t clips = layer.state() == PlayState::Stopped ? 0 : layer.mixer().activeClipCount();
        samples += (clips + (layer.poseShare() > 0.0f ? 1 : 0)) * (isAdditive(layer) ? 2 : 1);
        addActiveClips(layer, out);
    }
    // If samples are dropped, the weights of the others may not sum to 1.
    if (!isRestHidden || samples > PoseInstruction::maxSamples) addUpTo(1, {-1, PlayedClip::Part::Mixed}, out);
}

} // namespace osgGpuAnimation
