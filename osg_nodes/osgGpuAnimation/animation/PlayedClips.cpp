// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/PlayedClips.h>

#include <algorithm>
#include <cstddef>

namespace osgGpuAnimation
{

namespace
{

void addAtMost(std::ptrdiff_t times, const PlayedClip& clip, std::vector<PlayedClip>& out)
{
    if (std::count(out.begin(), out.end(), clip) < times) out.push_back(clip);
}

/// Whether nothing below the layer is seen.
bool coversAll(const AnimationLayer& layer)
{
    if (layer.mode() != AnimationLayer::Mode::Override || layer.mask() != 0 || layer.weight() < 1.0f) return false;
    double shares = 0.0;
    for (std::size_t v = 0; v < layer.mixer().voiceCount(); ++v)
        shares += layer.mixer().voice(v).share;
    return shares > 1.0 - 1e-6;
}

/// Samples that the layer's clips ask for, see SampleStack.
std::size_t samplesOf(const AnimationLayer& layer)
{
    return layer.mixer().voiceCount() * (layer.mode() == AnimationLayer::Mode::Additive ? 2 : 1);
}

// A clip that fades into itself is twice in it: mixed of two times it may show what it shows at none.
void addVoices(const AnimationLayer& layer, std::vector<PlayedClip>& out)
{
    for (std::size_t v = 0; v < layer.mixer().voiceCount(); ++v)
    {
        const int clip = layer.mixer().voice(v).playback.clip();
        if (layer.mode() == AnimationLayer::Mode::Override)
            addAtMost(2, {clip, PlayedClip::Part::Mixed}, out);
        else if (layer.reference() == AnimationLayer::Reference::RestPose)
            out.push_back({clip, PlayedClip::Part::AddedToRest});
        else
            out.push_back({clip, PlayedClip::Part::AddedToItsFirst});
    }
}

} // namespace

void findPlayedClips(const AnimationController& controller, std::vector<PlayedClip>& out)
{
    out.clear();
    bool isRestHidden = false;
    std::size_t samples = 0;
    for (std::size_t i = 0; i < controller.layerCount(); ++i)
    {
        const AnimationLayer& layer = controller.layer(i);
        if (layer.state() == PlayState::Stopped || !(layer.weight() > 0.0f)) continue;
        isRestHidden = isRestHidden || coversAll(layer);
        samples += samplesOf(layer);
        addVoices(layer, out);
    }
    // Where samples give way the others' weights may be too few.
    if (!isRestHidden || samples > PoseInstruction::maxSamples) addAtMost(1, {-1, PlayedClip::Part::Mixed}, out);
}

} // namespace osgGpuAnimation
