// SPDX-License-Identifier: MIT
#include "gltf/Report.h"

#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::size_t mostOfAKind = 100;

void add(std::vector<std::string>& list, std::size_t& count, std::string message)
{
    if (count < mostOfAKind) list.push_back(std::move(message));
    if (count == mostOfAKind) list.push_back("more of the kind follow and are not listed");
    ++count;
}

} // namespace

Report::Report(Messages& messages) : _messages(messages) {}

void Report::warn(std::string message)
{
    add(_messages.warnings, _warnings, std::move(message));
}

void Report::note(std::string message)
{
    add(_messages.notes, _notes, std::move(message));
}

} // namespace osgGpuAnimation::gltf
