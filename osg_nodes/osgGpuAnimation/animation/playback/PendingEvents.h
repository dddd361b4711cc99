// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>

#include <functional>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class AnimationSet;

/// Events of one or more controllers, for their callbacks. An owner of controllers delivers them after all have moved,
/// see ControllerDetail::advance().
class PendingEvents
{
public:
    /// An event of a controller with this callback and set.
    struct Event
    {
        std::weak_ptr<const std::function<void(const AnimationEvent&)>> callback;
        std::shared_ptr<const AnimationSet> set; ///< owns the marker
        AnimationEvent event;
    };

    void add(Event event) { _events.push_back(std::move(event)); }
    bool isEmpty() const { return _events.empty(); } ///< true if nobody waits for an event
    /// Calls the callbacks in the order of advance(). Skips callbacks that were removed or replaced and those of
    /// destroyed controllers.
    void deliver() const
    {
        for (const Event& pending : _events)
            if (const auto callback = pending.callback.lock()) (*callback)(pending.event);
    }

private:
    std::vector<Event> _events;
};

} // namespace osgGpuAnimation
