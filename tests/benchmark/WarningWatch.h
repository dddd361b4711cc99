// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Notify>

#include <string>

namespace osgGpuAnimation::benchmark
{

/// Takes what OSG says: figures are worth nothing where a program did not link (a notice) or OSG met a GL error, which
/// it then takes away from glGetError. Passes everything on to standard error.
class WarningWatch : public osg::NotifyHandler
{
public:
    void notify(osg::NotifySeverity severity, const char* message) override;

    /// All notices and what is graver, so far; empty if there were none.
    const std::string& warnings() const { return _warnings; }

private:
    std::string _warnings;
};

} // namespace osgGpuAnimation::benchmark
