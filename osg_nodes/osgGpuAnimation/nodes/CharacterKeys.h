// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgGA/GUIEventHandler>

#include <vector>

namespace osgGpuAnimation
{

/// Lines from each joint to its parent, drawn over everything: to be a child of an AnimatedCharacter of this set. They
/// are skinned as meshes are, from the GPU's palette, so they move with the character at no cost to the CPU.
osg::ref_ptr<SkinnedGeometry> makeJointLines(const AnimationSet& set);

/// Adds the lines to the character, or takes them away again.
void showJointLines(AnimatedCharacter& character, bool isShown);
bool hasJointLines(const AnimatedCharacter& character);

/// Keys for someone who looks at an AnimatedCharacter in a viewer: an event callback on the character. None of them is
/// a key of osgviewer's, and none is kept from other handlers, so all characters of a scene follow.
///
///     character->addEventCallback(new CharacterKeys);
///
/// | key | does |
/// | --- | --- |
/// | n N | next, previous clip, with a crossfade; at once, and still paused, where all is paused |
/// | k | pauses and resumes all layers |
/// | . , | a thirtieth of a second on, back; pauses |
/// | - + | slower, faster (= is + without shift) |
/// | r | the other way |
/// | j | joints as lines over the mesh |
///
/// At the first frame of the first viewer that reaches one, the keys are told on standard output, once a process: they
/// are help for who looks on, no notice about the file. Who sets OSG's notify level below NOTICE is not told. What a
/// key did is told at osg::NOTICE. An application that never has a viewer never hears of it.
///
/// Characters may share one: it keeps nothing of theirs.
class CharacterKeys : public osgGA::GUIEventHandler
{
public:
    CharacterKeys() = default;
    /// fadeSeconds: of the crossfades, at least 0.
    explicit CharacterKeys(double fadeSeconds) : _fadeSeconds(fadeSeconds) {}
    CharacterKeys(const CharacterKeys& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, CharacterKeys)

    double getFadeSeconds() const { return _fadeSeconds; }

    void setFadeSeconds(double seconds) { _fadeSeconds = seconds; } ///< at least 0

    using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// False where the key is none of these.
    bool press(int key, AnimatedCharacter& character) const;

protected:
    ~CharacterKeys() override = default;

private:
    bool isFirstTime(const osgGA::GUIEventAdapter& event, const osg::Object& character);
    void changeClip(AnimationController& controller, int step) const;

    double _fadeSeconds = 0.3;
    osg::ref_ptr<const osgGA::GUIEventAdapter> _event; ///< the last one
    std::vector<const osg::Object*> _told;             ///< who has had it
};

} // namespace osgGpuAnimation
