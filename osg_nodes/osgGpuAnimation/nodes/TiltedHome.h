// SPDX-License-Identifier: MIT
#pragma once

#include <osgGA/GUIEventHandler>

namespace osgGpuAnimation
{

/// An event callback on a node that lies flat on the ground, as a crowd does: viewers' home view sees it from a little
/// above instead of edge-on.
///
///     crowd->addEventCallback(new TiltedHome);
///
/// OSG's camera manipulators compute a home view that looks along +Y, level with the scene's middle. Where a view is
/// there as a frame begins (at first, and after its home key), it is raised by `degrees` about the scene's middle, at
/// the same distance. Nothing of the manipulator's is set but where it is now, and where it is anywhere else, where the
/// application has set a home position itself, or where the node's +Z is not the world's, nothing happens at all.
///
/// Nodes may share one: it keeps nothing of theirs. Scenes that are kept in OSG's formats keep it.
class TiltedHome : public osgGA::GUIEventHandler
{
public:
    static constexpr double degrees = 25.0;

    TiltedHome() = default;
    TiltedHome(const TiltedHome& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, TiltedHome)

        using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;

protected:
    ~TiltedHome() override = default;
};

} // namespace osgGpuAnimation
