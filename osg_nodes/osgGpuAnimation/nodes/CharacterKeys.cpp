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
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

constexpr std::pair<const char*, const char*> keyHelp[] = {
    {"n", "next clip"},  {"N", "previous clip"},     {"k", "pause, resume"},
    {".", "a frame on"}, {",", "a frame back"},      {"-", "slower"},
    {"+", "faster"},     {"r", "run the other way"}, {"j", "joints on, off"},
};

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

void printKeysOnce()
{
    static std::once_flag isPrinted;
    std::call_once(isPrinted,
                   []
                   {
                       std::string text;
                       for (const auto& [key, effect] : keyHelp)
                           text += (text.empty() ? "" : "; ") + std::string(key) + " " + effect;
                       if (osg::isNotifyEnabled(osg::NOTICE))
                           std::cout << "Keys of animated characters: " << text << std::endl;
                   });
}

} // namespace

CharacterKeys::CharacterKeys(const CharacterKeys& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop),
      _fadeSeconds(other._fadeSeconds)
{
}

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
    if (isFirstTime(event, *object) && press(event.getKey(), *character)) action.requestRedraw();
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

// A character with several parents receives each event once per parent.
bool CharacterKeys::isFirstTime(const osgGA::GUIEventAdapter& event, const osg::Object& character)
{
    if (_event != &event) _handled.clear();
    _event = &event;
    if (std::find(_handled.begin(), _handled.end(), &character) != _handled.end()) return false;
    _handled.push_back(&character);
    return true;
}

void CharacterKeys::getUsage(osg::ApplicationUsage& usage) const
{
    for (const auto& [key, effect] : keyHelp)
        usage.addKeyboardMouseBinding(key, std::string("Animated characters: ") + effect);
}

void CharacterKeys::changeClip(AnimationController& controller, int step) const
{
    const std::vector<Clip>& clips = controller.set().clips();
    const int count = static_cast<int>(clips.size());
    if (count == 0) return;
    const int clip = controller.clip() < 0 ? 0 : (controller.clip() + step + count) % count;
    // Fades do not advance while paused: show the next clip immediately and stay paused.
    const bool isPaused = controller.state() == PlayState::Paused;
    const bool isShown =
        static_cast<bool>(controller.crossfade(static_cast<std::size_t>(clip), isPaused ? 0.0 : _fadeSeconds));
    if (isPaused) controller.pause();
    if (isShown)
        OSG_NOTICE << "clip \"" << clips[static_cast<std::size_t>(clip)].name() << "\", " << clip + 1 << " of " << count
                   << std::endl;
}

bool CharacterKeys::press(int key, AnimatedCharacter& character) const
{
    AnimationController& controller = character.getController();
    switch (key)
    {
    case 'n':
        changeClip(controller, 1);
        return true;
    case 'N':
        changeClip(controller, -1);
        return true;
    case 'k':
        setPaused(controller, isAnyPlaying(controller));
        return true;
    case '.':
        step(controller, frameSeconds);
        return true;
    case ',':
        step(controller, -frameSeconds);
        return true;
    case '-':
    case osgGA::GUIEventAdapter::KEY_KP_Subtract:
        multiplySpeed(controller, 1.0 / speedFactor);
        return true;
    case '+':
    case '=':
    case osgGA::GUIEventAdapter::KEY_KP_Add:
        multiplySpeed(controller, speedFactor);
        return true;
    case 'r':
        multiplySpeed(controller, -1.0);
        return true;
    case 'j':
        showJointLines(character, !hasJointLines(character));
        return true;
    default:
        return false;
    }
}

} // namespace osgGpuAnimation
