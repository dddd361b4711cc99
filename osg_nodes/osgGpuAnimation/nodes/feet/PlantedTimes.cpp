// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/PlantedTimes.h>

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

/// From each touch marker to the next leave marker, which may be in the next round. Empty: the clip has no touch
/// marker.
std::vector<FootContact> contactsOfMarkers(const Clip& clip, const std::string& touchMarker,
                                           const std::string& leaveMarker)
{
    std::vector<FootContact> contacts;
    for (const ClipMarker& touch : clip.markers())
    {
        if (touch.name != touchMarker || touchMarker.empty()) continue;
        FootContact contact{touch.time, touch.time + clip.duration()};
        for (const ClipMarker& leave : clip.markers())
        {
            const double time = leave.time > touch.time ? leave.time : leave.time + clip.duration();
            if (leave.name == leaveMarker) contact.leave = std::min(contact.leave, time);
        }
        contacts.push_back(contact);
    }
    return contacts;
}

bool isWithin(const FootContact& contact, double time, double duration)
{
    const bool isWhole = contact.leave - contact.touch >= duration;
    return isWhole || (time >= contact.touch && time < contact.leave) || time + duration < contact.leave;
}

/// True if the layer decides where a joint is.
bool moves(const AnimationLayer& layer, const AnimationSet& set, std::size_t joint)
{
    if (layer.settings().mode != AnimationLayer::Mode::Override || layer.state() == PlayState::Stopped) return false;
    const std::shared_ptr<const SetMask> mask = set.masks().find(ControllerDetail::maskNumber(layer));
    return layer.weight() * (mask ? mask->weights[joint] : 1.0f) >= 0.5f;
}

} // namespace

const std::vector<PlantedTimes::Contact>& PlantedTimes::contactsOf(const AnimationSet& set, int clip)
{
    _contacts.resize(set.clips().size());
    const auto index = static_cast<std::size_t>(clip);
    if (_contacts[index]) return *_contacts[index];
    std::vector<FootContact> times = contactsOfMarkers(set.clips()[index], _touchMarker, _leaveMarker);
    if (times.empty()) times = findFootContacts(set, index, _contact).value();
    _contacts[index].emplace();
    for (const FootContact& time : times)
    {
        PoseInstruction touch;
        touch.samples[0] = set.sampleAt(clip, time.touch);
        const auto placeOf = [&](std::size_t joint)
        { return glm::dvec3(Pose::jointToModel(set, touch, joint).toColumns()[3]); };
        _contacts[index]->push_back({time, placeOf(_ankle), placeOf(_contact)});
    }
    return *_contacts[index];
}

/// Clips that run backwards or back and forth have no landing that is foreseen.
void PlantedTimes::findLanding(const AnimationSet& set, const ClipPlayback& playback, Now& now)
{
    if (!(playback.speed() > 0.0) || playback.loopMode() == LoopMode::PingPong) return;
    for (const Contact& contact : contactsOf(set, playback.clip()))
    {
        double away = contact.time.touch - playback.shownTime();
        if (away < 0.0 && playback.loopMode() == LoopMode::Loop) away += playback.duration();
        if (away < 0.0 || away / playback.speed() >= now.secondsToTouch) continue;
        now.secondsToTouch = away / playback.speed();
        now.ankle = contact.ankle;
        now.contact = contact.contact;
    }
}

PlantedTimes::Now PlantedTimes::now(const AnimationController& controller)
{
    const AnimationSet& set = controller.set();
    const auto plants = [&](const ClipPlayback& playback)
    {
        const std::vector<Contact>& contacts = contactsOf(set, playback.clip());
        const auto isNow = [&](const Contact& contact)
        { return isWithin(contact.time, playback.shownTime(), playback.duration()); };
        return !(playback.duration() > 0.0) || std::any_of(contacts.begin(), contacts.end(), isNow);
    };
    Now now;
    for (std::size_t i = controller.layerCount(); i-- > 0;)
    {
        const AnimationLayer& layer = controller.layer(i);
        if (!moves(layer, set, _contact)) continue;
        double shares = 0.0, planted = 0.0;
        const ClipMixer::ActiveClip* heaviest = nullptr;
        for (std::size_t v = 0; v < layer.mixer().activeClipCount(); ++v)
        {
            const ClipMixer::ActiveClip& active = layer.mixer().activeClip(v);
            if (active.playback.clip() < 0 || !(active.share > 0.0)) continue;
            shares += active.share;
            if (plants(active.playback)) planted += active.share;
            if (!heaviest || active.share > heaviest->share) heaviest = &active;
        }
        if (!heaviest) continue;
        now.isPlanted = planted >= 0.5 * shares;
        if (!now.isPlanted && layer.state() == PlayState::Playing) findLanding(set, heaviest->playback, now);
        break;
    }
    return now;
}

} // namespace osgGpuAnimation
