// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/PlantedTimes.h>

#include <osgGpuAnimation/animation/AnimationController.h>

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
    if (layer.mode() != AnimationLayer::Mode::Override || layer.state() == PlayState::Stopped) return false;
    const float* mask = set.masks().weights(layer.mask());
    return layer.weight() * (mask ? mask[joint] : 1.0f) >= 0.5f;
}

} // namespace

const std::vector<FootContact>& PlantedTimes::contactsOf(const AnimationSet& set, int clip)
{
    _contacts.resize(set.clips().size());
    const auto index = static_cast<std::size_t>(clip);
    if (!_contacts[index])
    {
        _contacts[index] = contactsOfMarkers(set.clips()[index], _touchMarker, _leaveMarker);
        if (_contacts[index]->empty()) _contacts[index] = findFootContacts(set, index, _contact).value();
    }
    return *_contacts[index];
}

bool PlantedTimes::isPlanted(const AnimationController& controller)
{
    const AnimationSet& set = controller.set();
    for (std::size_t i = controller.layerCount(); i-- > 0;)
    {
        const AnimationLayer& layer = controller.layer(i);
        if (!moves(layer, set, _contact)) continue;
        double shares = 0.0, planted = 0.0;
        for (std::size_t v = 0; v < layer.mixer().activeClipCount(); ++v)
        {
            const ClipMixer::ActiveClip& active = layer.mixer().activeClip(v);
            const ClipPlayback& playback = active.playback;
            if (playback.clip() < 0 || !(active.share > 0.0)) continue;
            shares += active.share;
            const std::vector<FootContact>& contacts = contactsOf(set, playback.clip());
            const auto isNow = [&](const FootContact& contact)
            { return isWithin(contact, playback.shownTime(), playback.duration()); };
            if (playback.duration() <= 0.0 || std::any_of(contacts.begin(), contacts.end(), isNow))
                planted += active.share;
        }
        if (shares > 0.0) return planted >= 0.5 * shares;
    }
    return true;
}

} // namespace osgGpuAnimation
