// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/export/PictureWriter.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/StateSet>
#include <osg/Uniform>

#include <cstddef>
#include <map>
#include <string>

namespace osgGpuAnimation::gltf
{

/// Writes StateSets as glTF materials (2.0, section 3.9, and the extensions of PbrMaterial), equal ones once. A
/// StateSet with a PbrMaterial becomes that material. Others have the look of the fixed pipeline: osg::Material's
/// diffuse colour becomes the base colour and its exponent the roughness, the texture of unit 0 the base colour map.
/// Texture transforms that the import left to the shader become KHR_texture_transform. Factors out of their range are
/// limited, with a warning.
class MaterialWriter
{
public:
    MaterialWriter(GlbWriter& writer, Report& report) : _writer(writer), _report(report), _pictures(writer, report) {}

    /// The index of the material. coordinates: bit n is set if the vertices have TEXCOORD_n; maps of others are left
    /// out. isColored: the vertices' colours replace the material's base colour.
    std::size_t materialOf(const osg::StateSet& state, unsigned int coordinates, bool isColored);

private:
    nlohmann::json written(const osg::StateSet& state, PbrMaterial material);
    void addMap(nlohmann::json& to, const char* member, const PbrMaterial::Map& map);
    void addExtensions(nlohmann::json& to, const PbrMaterial& material);
    void addExtension(nlohmann::json& to, const char* name, nlohmann::json extension);

    GlbWriter& _writer;
    Report& _report;
    PictureWriter _pictures;
    unsigned int _coordinates = 0;                 ///< of the material that is being written
    const osg::Uniform* _transforms = nullptr;     ///< likewise: of its coordinates; null: none
    std::map<std::string, std::size_t> _materials; ///< by text
};

bool hasTrueUniform(const osg::StateSet& state, const char* name);

} // namespace osgGpuAnimation::gltf
