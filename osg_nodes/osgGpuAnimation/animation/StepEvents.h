// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/animation/ClipMoveEvents.h>
#include <osgGpuAnimation/animation/PlayState.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// The last step of one layer.
struct LayerStep
{
    std::size_t layer = 0;
    const ClipMixer& mixer;
    double crossfadeMoment = -1.0; ///< share of the step after which the crossfade ended, in [0, 1]; -1: it did not end
    double weightFadeMoment = -1.0; ///< the same for the fade of the layer's weight

    /// False if the step has no events: a cheap test, since most steps have none. clips: of the layer's set.
    bool mayHaveEvents(const std::vector<Clip>& clips) const;
};

/// All events of one step of all layers in the order in which they happened. It copies what it needs of the layers, so
/// callbacks may modify them. Does not allocate.
class StepEvents
{
public:
    /// Adds the events of a layer. clips: of the layer's set; they must outlive this object.
    void add(const LayerStep& step, const std::vector<Clip>& clips);

    /// Goes to the next event; false after the last one.
    bool next(AnimationEvent& out);

private:
    struct Source
    {
        AnimationEvent event; ///< the next one
        std::optional<ClipMoveEvents> events;
        bool isFadingOut = false;
    };

    void addSource(const AnimationEvent& event, std::optional<ClipMoveEvents> events, bool isFadingOut);
    static bool goOn(Source& source);

    std::array<std::optional<Source>, maxLayers*(ClipMixer::maxVoices + 2)> _sources;
    std::size_t _count = 0;
};

} // namespace osgGpuAnimation
