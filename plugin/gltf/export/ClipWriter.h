// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/CharacterWriter.h"
#include "gltf/export/GlbWriter.h"
#include "gltf/file/Report.h"

#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace osgGpuAnimation::gltf
{

struct ClipKeys;

/// Writes the clips of characters as animations (glTF 2.0, section 3.11), with their markers as the import reads them
/// (see readClips()). Clips of one name in several characters are one animation, so that the characters move together.
class ClipWriter
{
public:
    ClipWriter(GlbWriter& writer, Report& report) : _writer(writer), _report(report) {}

    void write(const WrittenCharacter& character);

private:
    void write(const WrittenCharacter& character, const Clip& clip, bool isFirst, nlohmann::json& animation);
    void addChannel(nlohmann::json& animation, std::size_t node, const char* path, const char* type,
                    const ClipKeys& keys);

    GlbWriter& _writer;
    Report& _report;
    std::map<std::pair<std::string, std::size_t>, std::size_t> _number; ///< by name and its repetition
};

} // namespace osgGpuAnimation::gltf
