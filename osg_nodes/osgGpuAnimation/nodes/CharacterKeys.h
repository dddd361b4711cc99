// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/observer_ptr>
#include <osg/View>
#include <osgGA/GUIEventHandler>

#include <vector>

namespace osgGpuAnimation
{

/// Viewer keys for an AnimatedCharacter: an event callback on the character. None of the keys is used by osgviewer, and
/// no key is marked as handled, so all characters of a scene respond.
///
///     character->addEventCallback(new CharacterKeys);
///
/// | key | does |
/// | --- | --- |
/// | n N | next, previous clip, with a crossfade; immediately and still paused if all layers are paused |
/// | k | pauses and resumes all layers |
/// | . , | a thirtieth of a second forward, backward; pauses |
/// | - + | slower, faster (= is + without shift) |
/// | r | reverses the playback |
/// | j | shows the joints as lines over the mesh |
///
/// The first frame of the first viewer prints the list of keys to standard output, once per process, unless OSG's
/// notify level is below NOTICE. It also adds this object to the viewer's event handlers, so that the viewer's help
/// (`h` in osgviewer) lists the keys. The effect of a key is reported at osg::NOTICE.
///
/// Several characters may share one object: it keeps no data of theirs.
class CharacterKeys : public osgGA::GUIEventHandler
{
public:
    CharacterKeys() = default;
    /// fadeSeconds: duration of the crossfades, at least 0.
    explicit CharacterKeys(double fadeSeconds) : _fadeSeconds(fadeSeconds) {}
    /// Copies the duration of the crossfades.
    CharacterKeys(const CharacterKeys& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop),
          _fadeSeconds(other._fadeSeconds)
    {
    }
    META_Object(osgGpuAnimation, CharacterKeys)

    double getFadeSeconds() const { return _fadeSeconds; }          ///< duration of the crossfades
    void setFadeSeconds(double seconds) { _fadeSeconds = seconds; } ///< at least 0

    using osgGA::GUIEventHandler::handle;
    /// Handles key presses and always returns false.
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;
    /// Adds the keys to a viewer's help.
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Does what the key does; false: the key has no meaning here.
    bool press(int key, AnimatedCharacter& character) const;

protected:
    ~CharacterKeys() override = default;

private:
    void addToHelp(osgGA::GUIActionAdapter& action);

    double _fadeSeconds = 0.3;
    osg::observer_ptr<osg::View> _helped;              ///< the last view that addToHelp() has seen
    osg::ref_ptr<const osgGA::GUIEventAdapter> _event; ///< the last event
    std::vector<const osg::Object*> _handled;          ///< the characters that have handled _event
};

} // namespace osgGpuAnimation
