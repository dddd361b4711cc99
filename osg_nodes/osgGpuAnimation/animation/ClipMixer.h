// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipPlayback.h>
#include <osgGpuAnimation/animation/Fade.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The clips that one layer plays at a time: one, and while it crossfades those that are on their way out, which go on
/// playing. A crossfade may begin at any moment: what is seen then, however many clips make it up, fades as a whole
/// while the new clip fades in, so the pose never jumps. (A frozen pose in place of the fading clips would cost 48
/// bytes of upload a joint, and feet that stop in mid air.) Where all voices are in use, the one with the smallest
/// share gives way. Memory is taken where more clips fade out at once than ever before, and kept.
class ClipMixer
{
public:
    static constexpr std::size_t maxVoices = 8;

    struct Voice
    {
        ClipPlayback playback;
        ClipMove move;            ///< of the last advance()
        double share = 1.0;       ///< of the layer, now
        double meanShare = 1.0;   ///< over the last advance(): its way counts by this, whatever the frame rate
        double shareBefore = 0.0; ///< when the last crossfade began
        int phaseGroup = 0;       ///< voices of one group run at one phase
    };

    std::size_t voiceCount() const { return isEmpty() ? 0 : _leaving.size() + 1; }
    const Voice& voice(std::size_t index) const ///< oldest first
    {
        return index < _leaving.size() ? _leaving[index] : _current;
    }
    bool isEmpty() const { return _current.playback.clip() < 0; }
    /// The newest voice; there is one.
    ClipPlayback& current() { return _current.playback; }
    const ClipPlayback& current() const { return _current.playback; }
    bool isFading() const { return !_fade.isFinished(); }

    const Fade& fade() const { return _fade; } ///< from 0 to 1, the current voice's

    void clear();
    /// As it was when it said so of itself. voices: oldest first, at most maxVoices are taken.
    void restore(const std::vector<Voice>& voices, const Fade& fade);
    /// Alone and at once.
    void start(const ClipPlayback& playback);
    /// Over these seconds (above 0).
    void fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase);

    /// Moves all voices, the current one only if it is playing, and the fade. Returns when in the step the fade ended,
    /// in [0, 1]; -1 where it did not.
    double advance(double seconds, bool isCurrentPlaying);
    /// There was no step: no voice has moved.
    void stand();

private:
    Voice& at(std::size_t index) { return index < _leaving.size() ? _leaving[index] : _current; }
    void remove(std::size_t index);
    void removeFaded();
    void makeRoom();
    double clipSeconds(const Voice& voice, double seconds) const;

    Voice _current; ///< in place: of thousands of characters nearly all play one clip, and every frame reads it
    std::vector<Voice> _leaving; ///< below maxVoices
    Fade _fade{1.0};
    int _lastPhaseGroup = 0;
};

} // namespace osgGpuAnimation
