// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/ClipMoveEvents.h>

#include <array>
#include <cstddef>
#include <optional>

namespace osgGpuAnimation
{

/// All events of one step of all layers in the order in which they happened. It holds numbers of its own and looks at
/// the set's clips alone: the layers may change while it is told. Does not allocate.
class StepEvents
{
public:
    /// Whether there is anything to tell of the layer's last advance(): mostly not, and then this is the cheaper way.
    static bool hasEvents(const AnimationLayer& layer, const AnimationSet& set);

    /// What the layer did in its last advance(). The set must outlive this.
    void add(const AnimationLayer& layer, const AnimationSet& set);

    /// Goes to the next event; false where there is none any more.
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
