// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include "serializers/RegistryHooks.h"

#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/LayerSnapshot.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <osg/Notify>

#include <map>
#include <mutex>

namespace osgGpuAnimation::serializers
{

namespace
{

// Every file with objects of ours contains a set.
RegistryHooks registryHooks;

void transferJoints(ValueStream& stream, std::vector<Joint>& joints)
{
    stream.list("Joints", joints,
                [&](Joint& joint)
                {
                    stream.property("Joint").values(joint.parent, joint.sourceNode, joint.name);
                    stream.floats(&joint.rest.translation.x, 3).floats(&joint.rest.rotation.x, 4);
                    stream.floats(&joint.rest.scale.x, 3).endLine();
                });
}

void transferSkins(ValueStream& stream, const char* name, std::vector<Skin>& skins)
{
    const auto transferSkin = [&](Skin& skin)
    {
        stream.property("Skin").value(skin.name).endLine();
        const std::size_t count = stream.open("InverseBinds", skin.joints.size());
        for (std::size_t place = 0; place < count && stream.isGood(); ++place)
        {
            if (stream.isReading()) skin.joints.emplace_back();
            if (stream.isReading()) skin.inverseBinds.emplace_back();
            stream.property("Joint").values(skin.joints[place], skin.inverseBinds[place]).endLine();
        }
        stream.close();
    };
    stream.list(name, skins, transferSkin);
}

void transferMorphs(ValueStream& stream, std::vector<MorphWeights>& morphs)
{
    stream.list("Morphs", morphs,
                [&](MorphWeights& morph)
                {
                    std::size_t weights = morph.defaults.size();
                    stream.property("Morph").values(morph.sourceNode, morph.name, weights);
                    stream.numbers<float>(morph.defaults, weights).endLine();
                });
}

/// Of all compact clips of a set together; the default of the glTF reader's budget.
constexpr std::size_t maxCompactBytes = std::size_t(2) << 30;

void transferRootMotion(ValueStream& stream, std::shared_ptr<const RootMotionCurve>& motion)
{
    RootMotionCurve curve;
    if (motion) curve = *motion;
    const std::size_t count = stream.open("RootMotion", curve.keys.size());
    if (count > 0) stream.property("Joint").values(curve.joint, curve.up).endLine();
    const auto transferKey = [&](RootMotionCurve::Key& key)
    {
        stream.property("Key").value(key.yaw);
        for (RootMotionCurve::Point* point : {&key.displacement, &key.pivot})
            stream.values(point->value, point->in, point->out);
        stream.endLine();
    };
    stream.items(curve.keys, count, transferKey);
    stream.close();
    if (count > 0) motion = std::make_shared<const RootMotionCurve>(std::move(curve));
}

ClipParts toParts(const Clip& clip, std::size_t jointCount)
{
    ClipParts parts;
    parts.name = clip.name();
    parts.form = clip.form();
    parts.jointCount = jointCount;
    parts.trackCount = clip.trackCount();
    parts.times = clip.times();
    parts.data = clip.data();
    parts.markers = clip.markers();
    if (clip.rootMotion()) parts.rootMotion = std::make_shared<const RootMotionCurve>(*clip.rootMotion());
    if (clip.compactTracks()) parts.compactTracks = std::make_shared<const CompactTracks>(*clip.compactTracks());
    return parts;
}

void transferClip(ValueStream& stream, ClipParts& clip, std::size_t& compactBytesLeft)
{
    bool isCompact = clip.compactTracks != nullptr;
    stream.property("Clip").value(clip.name).limited("a clip's form", clip.form, Clip::Form::Spline);
    stream.value(isCompact).endLine();
    stream.block("Times", clip.times, 8);
    if (isCompact)
        transferCompactKeyframes(stream, clip, compactBytesLeft);
    else
        stream.block("Keyframes", clip.data, floatsATransform);
    stream.list("Markers", clip.markers,
                [&](ClipMarker& marker) { stream.property("Marker").values(marker.time, marker.name).endLine(); });
    transferRootMotion(stream, clip.rootMotion);
}

/// A clip that cannot be created makes the file unreadable; the message names it. Compact clips store their tracks and
/// records (see CompactTracks), the transforms at rest and the morph weights. Memory holds all their keyframes, so
/// these are limited.
void transferClips(ValueStream& stream, std::size_t jointCount, const std::vector<MorphWeights>& morphs,
                   std::vector<Clip>& clips)
{
    std::size_t trackCount = jointCount, compactBytesLeft = maxCompactBytes;
    for (const MorphWeights& morph : morphs)
        trackCount += morph.blockCount();
    const std::size_t count = stream.open("Clips", clips.size());
    for (std::size_t c = 0; c < count && stream.isGood(); ++c)
    {
        ClipParts parts;
        if (!stream.isReading()) parts = toParts(clips[c], jointCount);
        parts.jointCount = jointCount;
        parts.trackCount = trackCount;
        transferClip(stream, parts, compactBytesLeft);
        if (!stream.hasRead()) continue;
        Result<Clip> clip = Clip::create(std::move(parts));
        if (!clip) return stream.fail(clip.error().message);
        clips.push_back(std::move(clip).value());
    }
    stream.close();
}

/// Keyframes and skins refer to joints by their order in the file, which must be that of the skeleton.
Result<Skeleton> toSkeleton(const std::vector<Joint>& joints)
{
    Result<Skeleton> skeleton = Skeleton::create(joints);
    for (std::size_t i = 0; skeleton && i < joints.size(); ++i)
        if (skeleton.value().jointOfInput(i) != static_cast<int>(i))
            return Error{"joint " + std::to_string(i) + " \"" + joints[i].name + "\" is not stored level by level"};
    return skeleton;
}

/// An AnimationSet as an object of a file: OSG writes an object once, however many others refer to it.
class StoredAnimationSet : public osg::Object
{
public:
    StoredAnimationSet() = default;
    StoredAnimationSet(const StoredAnimationSet& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), _read(other._read), _written(other._written)
    {
    }
    META_Object(osgGpuAnimation, StoredAnimationSet)

    /// Always the same object for a set, by which a stream recognizes it. It does not keep the set alive.
    static osg::ref_ptr<StoredAnimationSet> of(const std::shared_ptr<const AnimationSet>& set)
    {
        static std::mutex mutex;
        static std::map<const AnimationSet*, osg::ref_ptr<StoredAnimationSet>> known;
        const std::lock_guard<std::mutex> lock(mutex);
        for (auto entry = known.begin(); entry != known.end();)
            entry = entry->second->_written.expired() ? known.erase(entry) : std::next(entry);
        osg::ref_ptr<StoredAnimationSet>& stored = known[set.get()];
        if (!stored) stored = new StoredAnimationSet;
        stored->_written = set;
        return stored;
    }

    /// Null if nothing was read, or the set no longer exists.
    std::shared_ptr<const AnimationSet> set() const { return _read ? _read : _written.lock(); }

    static void transferContents(ValueStream& stream, StoredAnimationSet& stored);

protected:
    ~StoredAnimationSet() override = default;

private:
    std::shared_ptr<const AnimationSet> _read;
    std::weak_ptr<const AnimationSet> _written;
};

void StoredAnimationSet::transferContents(ValueStream& stream, StoredAnimationSet& stored)
{
    std::vector<Constraint> constraints;
    std::vector<Joint> joints;
    std::vector<Skin> skins, garments;
    std::vector<int> rigidJoints;
    std::vector<MorphWeights> morphs;
    std::vector<Clip> clips;
    if (const auto set = stored.set())
    {
        joints = set->skeleton().joints();
        skins = set->skins();
        rigidJoints = set->rigidJoints();
        morphs = set->morphs();
        clips = set->clips();
        constraints = set->constraints();
        garments = set->garments();
    }
    stream.version("an animation set").endLine();
    transferJoints(stream, joints);
    transferSkins(stream, "Skins", skins);
    std::size_t count = rigidJoints.size();
    stream.property("RigidJoints").value(count);
    stream.items(rigidJoints, count, [&](int& joint) { stream.value(joint); });
    stream.endLine();
    transferMorphs(stream, morphs);
    transferClips(stream, joints.size(), morphs, clips);
    transferConstraints(stream, constraints);
    transferSkins(stream, "Garments", garments);
    if (!stream.hasRead()) return;
    Result<Skeleton> skeleton = toSkeleton(joints);
    if (!skeleton) return stream.fail(skeleton.error().message);
    Result<std::shared_ptr<const AnimationSet>> made =
        AnimationSet::create({std::move(skeleton).value(), std::move(skins), std::move(rigidJoints), std::move(morphs),
                              std::move(clips), std::move(constraints), std::move(garments)});
    if (!made) return stream.fail(made.error().message);
    stored._read = made.value();
}

void transferFade(ValueStream& stream, const char* name, LayerSnapshot::FadeState& fade)
{
    stream.property(name).values(fade.from, fade.to, fade.seconds, fade.elapsed);
    stream.limited("a fade's curve", fade.curve, FadeCurve::Smooth).endLine();
}

void transferActiveClip(ValueStream& stream, LayerSnapshot::ActiveClip& activeClip)
{
    stream.property("ActiveClip").values(activeClip.clip, activeClip.time, activeClip.speed);
    stream.limited("a loop mode", activeClip.loopMode, LoopMode::PingPong);
    stream.values(activeClip.isReturning, activeClip.isFresh, activeClip.share);
    stream.values(activeClip.shareBefore, activeClip.phaseGroup);
    stream.values(activeClip.space, activeClip.point, activeClip.weight).endLine();
}

/// A space that cannot be created becomes null, with a warning; its layer then does not play.
void transferSpace(ValueStream& stream, const AnimationSet& set, LayerSnapshot::ActiveSpace& space)
{
    std::vector<BlendSpace::Point> points;
    std::vector<std::string> markers;
    if (space.space) points = space.space->points();
    if (space.space) markers = space.space->syncMarkers();
    stream.property("Space").values(space.parameter.x, space.parameter.y, space.phase);
    stream.values(space.isReturning, space.isFresh).endLine();
    stream.list("Points", points,
                [&](BlendSpace::Point& point)
                { stream.property("Point").values(point.clip, point.place.x, point.place.y).endLine(); });
    stream.list("SyncMarkers", markers,
                [&](std::string& marker) { stream.property("Marker").value(marker).endLine(); });
    if (!stream.hasRead()) return;
    const auto made = BlendSpace::create(set, std::move(points), std::move(markers));
    if (made)
        space.space = made.value();
    else
        OSG_WARN << "osgGpuAnimation: a stored layer: " << made.error().message << std::endl;
}

void transferPosedTrack(ValueStream& stream, JointPose::Track& track)
{
    auto index = static_cast<std::int32_t>(track.track), numbers = static_cast<std::int32_t>(track.numbers);
    stream.property("Track").values(index, numbers);
    stream.floats(&track.values.translation.x, 4).floats(&track.values.rotation.x, 4);
    stream.floats(&track.values.scale.x, 4).endLine();
    track.track = static_cast<std::uint32_t>(index);
    track.numbers = static_cast<std::uint32_t>(numbers);
}

void transferLayer(ValueStream& stream, const AnimationSet& set, LayerSnapshot& layer)
{
    using Layer = AnimationLayer;
    stream.property("Layer").limited("a layer's state", layer.state, PlayState::Ended);
    stream.limited("a loop mode", layer.settings.loopMode, LoopMode::PingPong).value(layer.settings.speed);
    stream.limited("a layer's mode", layer.settings.mode, Layer::Mode::Additive);
    stream.limited("a layer's reference", layer.settings.reference, Layer::Reference::FirstFrame)
        .value(layer.settings.blendPriority);
    stream.endLine();
    stream.list("ActiveClips", layer.activeClips,
                [&](LayerSnapshot::ActiveClip& activeClip) { transferActiveClip(stream, activeClip); });
    transferFade(stream, "Crossfade", layer.crossfade);
    transferFade(stream, "Weight", layer.weight);
    stream.block("Mask", layer.mask, 8);
    stream.property("Parameter")
        .values(layer.settings.parameter.x, layer.settings.parameter.y, layer.settings.isPhaseShared)
        .endLine();
    stream.list("Spaces", layer.spaces, [&](LayerSnapshot::ActiveSpace& space) { transferSpace(stream, set, space); });
    stream.list("Pose", layer.pose, [&](JointPose::Track& track) { transferPosedTrack(stream, track); });
    transferFade(stream, "PoseShare", layer.poseShare);
}

const Wrapper<StoredAnimationSet> storedSet("StoredAnimationSet", "", "Contents",
                                            &StoredAnimationSet::transferContents);

} // namespace

void transferAnimationSet(ValueStream& stream, std::shared_ptr<const AnimationSet>& set)
{
    osg::ref_ptr<StoredAnimationSet> stored;
    if (!stream.isReading()) stored = StoredAnimationSet::of(set);
    stream.begin();
    stream.object(stored);
    stream.close();
    if (!stream.isReading()) return;
    set = stored ? stored->set() : nullptr;
    if (!set) stream.fail("a character without an animation set");
}

void transferController(ValueStream& stream, AnimationController& controller)
{
    stream.version("a controller").endLine();
    const std::size_t layers = stream.open("Layers", controller.layerCount());
    if (layers > maxLayers) stream.fail(std::to_string(layers) + " layers, at most " + std::to_string(maxLayers));
    for (std::size_t i = 0; i < layers && stream.isGood(); ++i)
    {
        LayerSnapshot layer;
        if (!stream.isReading()) layer = LayerSnapshot::of(controller.layer(i));
        transferLayer(stream, controller.set(), layer);
        if (!stream.hasRead()) continue;
        if (const Result<void> restored = layer.restoreTo(controller.layer(i)); !restored)
            OSG_WARN << "osgGpuAnimation: layer " << i << " of a character: " << restored.error().message
                     << "; it does not play" << std::endl;
    }
    stream.close();
    transferTargets(stream, controller);
}

void transferMatrix(ValueStream& stream, osg::Matrixd& matrix)
{
    for (int number = 0; number < 16; ++number)
        stream.value(matrix.ptr()[number]);
}

} // namespace osgGpuAnimation::serializers
