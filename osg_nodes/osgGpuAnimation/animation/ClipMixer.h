// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipPlayback.h>
#include <osgGpuAnimation/animation/Fade.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The clips that one layer plays at a time: the current clip and, during crossfades, the clips that fade out and play
/// on. A crossfade may begin at any time: the whole visible mix fades out while the new clip fades in, so the pose
/// never jumps. (A frozen pose in place of the fading clips would upload 48 bytes per joint, and feet would stop in mid
/// air.) If all voices are in use, the one with the smallest share is dropped. Memory grows only when more clips fade
/// out at once than ever before.
class ClipMixer
{
public:
    static constexpr std::size_t maxVoices = 8;

    struct Voice
    {
        ClipPlayback playback;
        ClipMove move;      ///< the step of the last advance()
        double share = 1.0; ///< of the layer, in [0, 1]
        double meanShare =
            1.0; ///< mean during the last advance(): it weights root motion, so that the frame rate plays no part
        double shareBefore = 0.0; ///< share at the start of the last crossfade
        int phaseGroup = 0;       ///< voices of one group share one phase
    };

    std::size_t voiceCount() const { return isEmpty() ? 0 : _leaving.size() + 1; }
    const Voice& voice(std::size_t index) const ///< oldest first
    {
        return index < _leaving.size() ? _leaving[index] : _current;
    }
    bool isEmpty() const { return _current.playback.clip() < 0; }
    /// The newest voice. The mixer must not be empty.
    ClipPlayback& current() { return _current.playback; }
    const ClipPlayback& current() const { return _current.playback; }
    bool isFading() const { return !_fade.isFinished(); }

    const Fade& fade() const { return _fade; } ///< share of the current voice, from 0 to 1

    void clear();
    /// Restores stored voices. voices: oldest first; only the first maxVoices are used.
    void restore(const std::vector<Voice>& voices, const Fade& fade);
    /// Plays a clip at once and removes all others.
    void start(const ClipPlayback& playback);
    /// Starts a crossfade. seconds: above 0. sharesPhase: true if both clips run at one phase, see Sync::Phase.
    void fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase);

    /// Moves the fade and all voices; the current voice moves only if isCurrentPlaying. Returns the share of the step
    /// after which the fade ended, in [0, 1]; -1 if it did not end.
    double advance(double seconds, bool isCurrentPlaying);
    /// Clears the steps of all voices.
    void stand();

private:
    Voice& at(std::size_t index) { return index < _leaving.size() ? _leaving[index] : _current; }
    void remove(std::size_t index);
    void removeFaded();
    void makeRoom();
    double clipSeconds(const Voice& voice, double seconds) const;

    Voice _current;              ///< a member, since most characters play one clip and every frame reads it
    std::vector<Voice> _leaving; ///< fewer than maxVoices
    Fade _fade{1.0};
    int _lastPhaseGroup = 0;
};

} // namespace osgGpuAnimation
