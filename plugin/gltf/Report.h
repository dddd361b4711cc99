// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Messages.h"

#include <cstddef>
#include <string>

namespace osgGpuAnimation::gltf
{

/// Collects the messages of one load. A file may hold a million faults: after the first hundred of a kind one line
/// says that there are more.
///
///     report.warn("nodes[3].skin: the mesh has no JOINTS_0; the skin is ignored");
class Report
{
public:
    explicit Report(Messages& messages);

    void warn(std::string message);
    void note(std::string message);

private:
    Messages& _messages;
    std::size_t _warnings = 0;
    std::size_t _notes = 0;
};

} // namespace osgGpuAnimation::gltf
