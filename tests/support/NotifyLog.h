// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Notify>

#include <string>

namespace osgGpuAnimation
{

/// Keeps OSG's messages from a severity on and prints nothing.
///
///     osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
///     osg::setNotifyHandler(log); // and in the end osg::setNotifyHandler(new osg::StandardNotifyHandler)
class NotifyLog : public osg::NotifyHandler
{
public:
    explicit NotifyLog(osg::NotifySeverity least) : _least(least) {}
    void notify(osg::NotifySeverity severity, const char* message) override
    {
        if (severity <= _least) text += message;
    }
    std::string text;

private:
    osg::NotifySeverity _least;
};

} // namespace osgGpuAnimation
