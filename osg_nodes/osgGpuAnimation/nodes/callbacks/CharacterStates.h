// SPDX-License-Identifier: MIT
#pragma once

#include <osg/observer_ptr>
#include <osg/Transform>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>

namespace osgGpuAnimation
{

class AnimatedCharacter;

/// The states that a callback keeps for the characters that share it. Cameras may cull concurrently.
template <typename State>
class CharacterStates
{
public:
    /// The state of the character; a new one at the first call. Forgets those of deleted characters.
    State& of(AnimatedCharacter& character)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return entryOf(character).state;
    }

    /// Records the distance of a camera that culls the character at the end of the visitor's path, in world units.
    void see(AnimatedCharacter& character, osgUtil::CullVisitor& visitor)
    {
        const osg::Vec3d eye = visitor.getCurrentCamera()->getInverseViewMatrix().getTrans();
        const double distance = (osg::computeLocalToWorld(visitor.getNodePath()).getTrans() - eye).length();
        const unsigned int frame = visitor.getFrameStamp()->getFrameNumber();
        const std::lock_guard<std::mutex> lock(_mutex);
        Entry& entry = entryOf(character);
        entry.distance = entry.frame == frame ? std::min(entry.distance, distance) : distance;
        entry.frame = frame;
    }

    /// True if a camera has drawn the character in the last frame within the distance, or if the distance is infinite.
    /// frame: the present one, in which no camera has culled yet.
    bool isWithin(AnimatedCharacter& character, double distance, unsigned int frame)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const Entry& entry = entryOf(character);
        return std::isinf(distance) || (entry.frame && frame - *entry.frame <= 1u && entry.distance <= distance);
    }

    void clear() { _states.clear(); }

    /// function(character, state), for characters that exist.
    template <typename Function>
    void forEach(Function function)
    {
        for (auto& [key, entry] : _states)
            if (osg::ref_ptr<AnimatedCharacter> character; entry.character.lock(character))
                function(*character, entry.state);
    }

private:
    struct Entry
    {
        osg::observer_ptr<AnimatedCharacter> character;
        State state;
        double distance = 0.0; ///< from which cameras saw it in that frame
        std::optional<unsigned int> frame;
    };

    /// The mutex is locked.
    Entry& entryOf(AnimatedCharacter& character)
    {
        const auto found = _states.find(&character);
        if (found != _states.end() && found->second.character.valid()) return found->second;
        for (auto entry = _states.begin(); entry != _states.end();)
            entry = entry->second.character.valid() ? std::next(entry) : _states.erase(entry);
        Entry& entry = _states[&character];
        entry.character = &character;
        return entry;
    }

    std::mutex _mutex;
    std::map<const AnimatedCharacter*, Entry> _states;
};

} // namespace osgGpuAnimation
