// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class ChannelCurve;

/// Converts channels, each with its own times, into a Clip: keyframes of all tracks at the union of all key times.
///
/// - LINEAR is exact: a slerp cut in two gives the same slerp.
/// - STEP becomes two keyframes at one time.
/// - A clip with a CUBICSPLINE channel becomes a Spline clip; each piece of a cut Hermite curve is the same curve.
/// - Tracks without a channel take the rest transform.
/// - Before its first key a channel has its first value, after its last key its last value.
///
/// Key times are 32-bit floats, as in a file, and stay exact. A turn of 180 degrees gets a keyframe in its middle,
/// since its direction would depend on the rounding of its ends. The builder computes in double precision and rounds
/// once; values beyond the range of a float become the largest float.
class ClipBuilder
{
public:
    /// For clips of the skeleton's joints and these morphs; copies what it needs of both.
    ClipBuilder(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

    /// Adds a channel. Errors name the channel: no times; times that are negative, not finite or not ascending as
    /// floats; a wrong number of values; values that are not finite; a target out of range; a rotation of length 0; a
    /// weight that the morph does not have; a second channel with the same target and path (and weight). After an error
    /// the builder ignores that channel and remains usable.
    Result<bool> add(Channel channel);

    /// Creates the clip of all channels that were added since the last build(). Without channels the clip has one
    /// keyframe, the rest pose at time 0.
    Clip build(std::string name);

    /// Bytes of the clip that build() would create now, so that a caller can refuse it before the allocation.
    std::size_t byteSize() const;

private:
    std::vector<ChannelCurve> curves() const;
    Clip::Form form() const;
    std::size_t componentCount(const Channel& channel) const;
    std::string describe(const Channel& channel) const;
    /// The first and the last key + 1 of what the channel drives.
    std::pair<std::size_t, std::size_t> keysOf(const Channel& channel) const;

    std::vector<JointTransform> _rest;
    std::size_t _jointCount;
    std::vector<std::size_t> _firstTrackOfMorph; ///< and at the end the number of tracks
    std::vector<std::size_t> _weightCounts;      ///< by morph
    std::vector<Channel> _channels;
    std::vector<std::size_t> _firstKeyOfMorph; ///< and at the end the number of keys
    std::vector<bool> _driven;                 ///< by key: three paths per joint, then the weights of each morph
};

/// Options of compactClips().
struct CompactOptions
{
    /// The largest error of a vertex or a joint in the model's units, above 0: for example a fraction of
    /// longestSide().
    double tolerance = 0.0;
};

/// A set with compact clips, and their errors.
struct CompactedSet
{
    std::shared_ptr<const AnimationSet> set; ///< never null
    std::vector<double> errors;              ///< one per clip, in the model's units; 0 for an unchanged clip
};

/// Makes the clips of a set smaller, on the GPU and on the CPU: parts that hardly move become constant, keyframes that
/// their neighbours predict are dropped, and each number of a part takes as few bits as the error allows, 0 to 20.
///
///     const auto compact = compactClips(set, entryBoxes, {1e-4 * longestSide(set, entryBoxes)});
///
/// The error is measured at every keyframe of the exact clip and halfway between them: at the joints' origins, at half
/// the longestSide() from them along each axis of the joint (where something may be attached), and at the corners of
/// the entries' boxes (a vertex is a convex combination of those). A clip that would exceed the tolerance stays exact,
/// as do Spline clips and clips that are compact already. Morph weights, and the keyframes of clips with root motion,
/// are kept exactly. A mix of clips has at most their errors; an additive layer adds the errors of the clip and of its
/// reference.
///
/// entryBoxes: one box per palette entry. Errors: a tolerance that is not finite and above 0; a wrong number of boxes.
Result<CompactedSet> compactClips(const AnimationSet& set, const EntryBoxes& entryBoxes, const CompactOptions& options);

/// The longest side of the rest pose's box in the model's units; of its joints' origins if no entry moves vertices.
double longestSide(const AnimationSet& set, const EntryBoxes& entryBoxes);

/// The parts of a joint's motion that withRootMotion() removes from the clips, to move the whole character instead.
struct RootMotionAxes
{
    bool horizontal = true;       ///< translation perpendicular to the up axis
    bool vertical = false;        ///< translation along it
    bool yaw = false;             ///< rotation about it
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< in model space, +Y in glTF; need not be unit
};

/// Removes a joint's motion from every clip of a set; AnimationController::takeRootMotion() returns the removed motion.
/// The joint stays where it is in the first keyframe of each clip. The new set has copies of all keyframes.
///
///     auto set = withRootMotion(fox->getAnimationSet(), "hips", {true, false, true});
///     if (set) fox->setAnimationSet(set.value());
///
/// Root motion and remaining clip together give the original pose, exactly at keyframes and, without yaw, between them.
/// With yaw they differ between keyframes as an arc differs from its chord.
/// Errors: no such joint; a clip whose root motion was removed before (start from the original set); an up axis of
/// length 0 or not finite; a clip that moves an ancestor of the joint; a joint below a transform that is not a
/// rotation, a translation and a uniform scale.
Result<std::shared_ptr<const AnimationSet>> withRootMotion(const AnimationSet& set, const std::string& joint,
                                                           const RootMotionAxes& axes = {});

/// A time during which a joint touches the ground.
struct FootContact
{
    double touch = 0.0; ///< seconds, in [0, duration)
    double leave = 0.0; ///< seconds, above touch; beyond the duration: in the next round of a loop
};

/// Finds the times at which a joint touches and leaves the ground, for example for markers of footsteps:
///
///     auto steps = findFootContacts(set, "Walk", "toes.l");
///     for (const FootContact& step : steps.value()) markers.push_back({step.touch, "left foot"});
///
/// The joint is on the ground where it is in the lowest fifth of its lift and moves about as fast as at its lowest
/// places; contacts and gaps below 3 % of the clip do not count. The clip is sampled 240 times a second, with +Y up. A
/// joint that lifts by less than 1 % of the skeleton's height has one contact, the whole clip. Joints at the sole
/// (toes) give better times than ankles. A clip of duration 0 has no contacts. Contacts are in the order of touch.
/// Errors: no such clip, no such joint.
Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, const std::string& clip,
                                                  const std::string& joint);
/// The same by number.
Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, std::size_t clip, std::size_t joint);

} // namespace osgGpuAnimation
