// SPDX-License-Identifier: MIT
#pragma once

#include <osg/observer_ptr>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>

namespace osgGpuAnimation
{

class AnimatedCharacter;

/// The distance from which cameras saw a character last.
class SeenDistance
{
public:
    void sawFrom(double distance, unsigned int frame)
    {
        _distance = frame == _frame ? std::min(_distance, distance) : distance;
        _frame = frame;
    }
    /// True if a camera has drawn the character in the last frame within the distance, or if the distance is infinite.
    /// frame: the present one, in which no camera has culled yet.
    bool isWithin(double distance, unsigned int frame) const
    {
        return std::isinf(distance) || (_frame && frame - *_frame <= 1u && _distance <= distance);
    }

private:
    double _distance = 0.0; ///< in world units, in the frame _frame
    std::optional<unsigned int> _frame;
};

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

    /// Records the distance of a camera that draws the character, in world units. frame: the camera's.
    void sawFrom(AnimatedCharacter& character, double distance, unsigned int frame)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        entryOf(character).seen.sawFrom(distance, frame);
    }
    /// See SeenDistance::isWithin().
    bool isWithin(AnimatedCharacter& character, double distance, unsigned int frame)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return entryOf(character).seen.isWithin(distance, frame);
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
        SeenDistance seen;
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
