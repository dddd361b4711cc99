// SPDX-License-Identifier: MIT
#pragma once

#include <osgGA/GUIEventHandler>

namespace osgGpuAnimation
{

/// An event callback: viewers' home view shows the node from in front, a little from the side and from above, as large
/// as the window allows (see fillingDirection()).
///
///     studio->addEventCallback(new RaisedHome);
///
/// It sets the home position of a view's camera manipulator at the view's first frame, and moves there. A manipulator
/// whose home position the application has set (getAutoComputeHomePosition() is false), and cameras without a
/// perspective keep theirs. Nodes may share one: it has no state.
class RaisedHome : public osgGA::GUIEventHandler
{
public:
    RaisedHome() = default;
    RaisedHome(const RaisedHome& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop)
    {
    }
    META_Object(osgGpuAnimation, RaisedHome)

    using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;

protected:
    ~RaisedHome() override = default;
};

} // namespace osgGpuAnimation
