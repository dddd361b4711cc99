// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Notify>

#include <string>

namespace osgGpuAnimation::benchmark
{

/// Records OSG's messages and passes them on to standard error. Figures are invalid if a program did not link (OSG
/// prints a notice) or a GL error occurred (OSG prints it and clears glGetError).
class WarningWatch : public osg::NotifyHandler
{
public:
    void notify(osg::NotifySeverity severity, const char* message) override;

    /// All messages of severity NOTICE or higher so far; empty if there were none.
    const std::string& warnings() const { return _warnings; }

private:
    std::string _warnings;
};

} // namespace osgGpuAnimation::benchmark
