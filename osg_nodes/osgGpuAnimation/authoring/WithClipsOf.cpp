// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/WithClipsOf.h>

#include <osgGpuAnimation/authoring/retarget/ClipRetargeter.h>

#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// Gives names that the clips of a set have a number.
class FreeNames
{
public:
    explicit FreeNames(const std::vector<Clip>& clips)
    {
        for (const Clip& clip : clips)
            _taken.insert(clip.name());
        _own = _taken;
    }

    std::string nameFor(const std::string& name)
    {
        std::string free = name;
        for (std::size_t& number = _numbers[name]; _own.count(name) > 0 && _taken.count(free) > 0;)
            free = name + " " + std::to_string(2 + number++);
        _taken.insert(free);
        return free;
    }

private:
    std::unordered_set<std::string> _own;   ///< of the set
    std::unordered_set<std::string> _taken; ///< and given
    std::unordered_map<std::string, std::size_t> _numbers;
};

/// True if a clip has other weights than the defaults in this morph.
bool isMorphMoved(const AnimationSet& set, std::size_t morph)
{
    const std::size_t first = set.firstTrackOfMorph(morph);
    const std::size_t end = first + set.morphs()[morph].blockCount();
    for (const Clip& clip : set.clips())
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
            for (std::size_t track = first; track < end; ++track)
                for (std::size_t number = 0; number < MorphWeights::weightsPerBlock; ++number)
                    if (clip.at(k, track)->number(number) != set.restPose()[track].number(number)) return true;
    return false;
}

/// By index of the other set: true if it is somebody's counterpart.
std::vector<bool> usedOf(std::size_t count, const std::vector<int>& counterparts)
{
    std::vector<bool> isUsed(count, false);
    for (const int counterpart : counterparts)
        if (counterpart >= 0) isUsed[counterpart] = true;
    return isUsed;
}

/// The names of those without a counterpart.
std::vector<std::string> atRest(const AnimationSet& set, const RigMatch& match)
{
    std::vector<std::string> names;
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
        if (match.jointCounterparts()[joint] < 0) names.push_back(set.skeleton().joint(joint).name);
    for (std::size_t morph = 0; morph < set.morphs().size(); ++morph)
        if (match.morphCounterparts()[morph] < 0 && !set.morphs()[morph].isProperty())
            names.push_back(set.morphs()[morph].name);
    return names;
}

/// The names of those that clips of the other set move and that are nobody's counterpart.
std::vector<std::string> leftOut(const AnimationSet& other, const RigMatch& match)
{
    const std::vector<bool> isMoved = movedJoints(other.skeleton(), other.clips());
    const std::vector<bool> isUsed = usedOf(isMoved.size(), match.jointCounterparts());
    const std::vector<bool> isMorphUsed = usedOf(other.morphs().size(), match.morphCounterparts());
    std::vector<std::string> names;
    for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
        if (isMoved[joint] && !isUsed[joint]) names.push_back(other.skeleton().joint(joint).name);
    for (std::size_t morph = 0; morph < isMorphUsed.size(); ++morph)
        if (!isMorphUsed[morph] && isMorphMoved(other, morph)) names.push_back(other.morphs()[morph].name);
    return names;
}

} // namespace

Result<RetargetedSet> withClipsOf(const AnimationSet& set, const AnimationSet& other, const RetargetOptions& options)
{
    if (other.clips().empty()) return Error{"the other set has no clips"};
    const Result<ClipRetargeter> retargeter = ClipRetargeter::create({other.skeleton(), other.morphs(), &other.clips()},
                                                                     {set.skeleton(), set.morphs()}, options);
    if (!retargeter) return retargeter.error();
    FreeNames names(set.clips());
    std::vector<Clip> clips = set.clips();
    for (const Clip& clip : other.clips())
    {
        Result<Clip> made = retargeter.value().retarget(clip);
        if (!made) return made.error();
        clips.push_back(made.value().withName(names.nameFor(clip.name())));
    }
    Result<std::shared_ptr<const AnimationSet>> made = set.withClips(std::move(clips));
    if (!made) return made.error();
    const RigMatch& match = retargeter.value().match();
    RetargetedSet result{made.value(), atRest(set, match), leftOut(other, match)};
    for (const JointMatch& joint : match.joints())
    {
        result.byName += joint.isByName;
        result.retargeted += !joint.isByName && !joint.isSameRig;
    }
    return result;
}

} // namespace osgGpuAnimation
