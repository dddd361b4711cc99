// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CharacterKeys.h>

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/nodes/JointLines.h>

#include <osg/ApplicationUsage>
#include <osg/Notify>
#include <osgViewer/View>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <mutex>

namespace osgGpuAnimation
{

namespace
{

constexpr double frameSeconds = 1.0 / 30.0;
constexpr double speedFactor = 1.25;
constexpr double slowest = 1.0 / 64.0, fastest = 64.0;

template <typename Function>
void forEachLayer(AnimationController& controller, Function function)
{
    for (std::size_t i = 0; i < controller.layerCount(); ++i)
        function(controller.layer(i));
}

bool isAnyPlaying(AnimationController& controller)
{
    bool isPlaying = false;
    forEachLayer(controller,
                 [&](AnimationLayer& layer) { isPlaying = isPlaying || layer.state() == PlayState::Playing; });
    return isPlaying;
}

void setPaused(AnimationController& controller, bool isPaused)
{
    forEachLayer(controller, [&](AnimationLayer& layer) { isPaused ? layer.pause() : layer.resume(); });
}

/// Steps all layers and pauses them. Fades do not run backward.
void step(AnimationController& controller, double seconds)
{
    setPaused(controller, false);
    std::vector<AnimationLayer*> ended;
    forEachLayer(controller,
                 [&](AnimationLayer& layer)
                 {
                     if (layer.state() == PlayState::Ended) ended.push_back(&layer);
                 });
    controller.advance(seconds);
    // An ended layer does not advance, but it can step backward.
    for (AnimationLayer* layer : ended)
        if (seconds < 0.0) layer->seek(layer->playback().time() + seconds * layer->settings().speed);
    setPaused(controller, true);
    OSG_NOTICE << "at " << controller.time() << " s of " << controller.duration() << std::endl;
}

void multiplySpeed(AnimationController& controller, double factor)
{
    forEachLayer(controller,
                 [&](AnimationLayer& layer)
                 {
                     const double wanted = layer.settings().speed * factor;
                     layer.setSpeed(std::copysign(std::clamp(std::abs(wanted), slowest, fastest), wanted));
                     // An ended layer resumes after a change of direction.
                     if (factor < 0.0 && layer.state() == PlayState::Ended) layer.seek(layer.playback().time());
                 });
    OSG_NOTICE << "speed " << controller.layer(0).settings().speed << std::endl;
}

void changeClip(AnimationController& controller, int step, double fadeSeconds)
{
    const std::vector<Clip>& clips = controller.set().clips();
    const int count = static_cast<int>(clips.size());
    if (count == 0) return;
    const int clip = controller.clip() < 0 ? 0 : (controller.clip() + step + count) % count;
    // Fades do not advance while paused: show the next clip immediately and stay paused.
    const bool isPaused = controller.state() == PlayState::Paused;
    const bool isShown =
        static_cast<bool>(controller.crossfade(static_cast<std::size_t>(clip), isPaused ? 0.0 : fadeSeconds));
    if (isPaused) controller.pause();
    if (isShown)
        OSG_NOTICE << "clip \"" << clips[static_cast<std::size_t>(clip)].name() << "\", " << clip + 1 << " of " << count
                   << std::endl;
}

struct Key
{
    char key;
    const char* effect;
    void (*press)(AnimatedCharacter& character, AnimationController& controller, double fadeSeconds);
};

const Key keys[] = {
    {'n', "next clip", [](auto&, auto& controller, double fade) { changeClip(controller, 1, fade); }},
    {'N', "previous clip", [](auto&, auto& controller, double fade) { changeClip(controller, -1, fade); }},
    {'k', "pause, resume", [](auto&, auto& controller, double) { setPaused(controller, isAnyPlaying(controller)); }},
    {'.', "a frame on", [](auto&, auto& controller, double) { step(controller, frameSeconds); }},
    {',', "a frame back", [](auto&, auto& controller, double) { step(controller, -frameSeconds); }},
    {'-', "slower", [](auto&, auto& controller, double) { multiplySpeed(controller, 1.0 / speedFactor); }},
    {'+', "faster", [](auto&, auto& controller, double) { multiplySpeed(controller, speedFactor); }},
    {'r', "run the other way", [](auto&, auto& controller, double) { multiplySpeed(controller, -1.0); }},
    {'j', "joints on, off",
     [](auto& character, auto&, double) { showJointLines(character, !hasJointLines(character)); }},
};

void printKeysOnce()
{
    static std::once_flag isPrinted;
    std::call_once(isPrinted,
                   []
                   {
                       std::string text;
                       for (const Key& key : keys)
                           text += (text.empty() ? "" : "; ") + std::string(1, key.key) + " " + key.effect;
                       if (osg::isNotifyEnabled(osg::NOTICE))
                           std::cout << "Keys of animated characters: " << text << std::endl;
                   });
}

} // namespace

bool CharacterKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                           osg::NodeVisitor*)
{
    auto* character = dynamic_cast<AnimatedCharacter*>(object);
    if (!character || event.getHandled()) return false;
    if (event.getEventType() == osgGA::GUIEventAdapter::FRAME)
    {
        printKeysOnce();
        addToHelp(action);
    }
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
    PoseStatistics::addLines(action);
    // A character with several parents receives each event once per parent.
    if (_event != &event) _handled.clear();
    _event = &event;
    if (std::find(_handled.begin(), _handled.end(), object) != _handled.end()) return false;
    _handled.push_back(object);
    if (press(event.getKey(), *character)) action.requestRedraw();
    return false;
}

// A viewer's help asks only the handlers in the viewer's own list. There, this object has no character and ignores
// events.
void CharacterKeys::addToHelp(osgGA::GUIActionAdapter& action)
{
    if (!action.asView() || _helped == action.asView()) return;
    _helped = action.asView();
    auto* view = dynamic_cast<osgViewer::View*>(_helped.get());
    if (!view) return;
    const auto& handlers = view->getEventHandlers();
    const auto isKeys = [](const auto& handler)
    { return dynamic_cast<const CharacterKeys*>(handler.get()) != nullptr; };
    if (std::none_of(handlers.begin(), handlers.end(), isKeys)) view->addEventHandler(this);
}

void CharacterKeys::getUsage(osg::ApplicationUsage& usage) const
{
    for (const Key& key : keys)
        usage.addKeyboardMouseBinding(std::string(1, key.key), std::string("Animated characters: ") + key.effect);
}

bool CharacterKeys::press(int key, AnimatedCharacter& character) const
{
    if (key == osgGA::GUIEventAdapter::KEY_KP_Subtract) key = '-';
    if (key == '=' || key == osgGA::GUIEventAdapter::KEY_KP_Add) key = '+';
    const auto known =
        std::find_if(std::begin(keys), std::end(keys), [key](const Key& each) { return each.key == key; });
    if (known == std::end(keys)) return false;
    known->press(character, character.getController(), _fadeSeconds);
    return true;
}

} // namespace osgGpuAnimation
