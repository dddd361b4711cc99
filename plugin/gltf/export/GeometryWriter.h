// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/export/MaterialWriter.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Geometry>
#include <osg/StateSet>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Writes drawables as primitives of glTF meshes (2.0, section 3.7.2), arrays that are shared once. Quads, polygons,
/// strips and fans become triangles. Texture matrices of the fixed pipeline, and normals and colours of whole
/// primitives, are left out.
class GeometryWriter
{
public:
    /// variants: the names of all material variants of the scene, in the order of the file.
    GeometryWriter(GlbWriter& writer, const std::vector<std::string>& variants, Report& report)
        : _writer(writer), _materials(writer, report), _variants(variants), _report(report)
    {
    }

    /// The palette entries of a skin by their places in it.
    using SkinPlaces = std::map<std::size_t, std::uint16_t>;

    /// The primitives of a drawable, an array. state: that of the drawable and those above it. skin: null: the vertices
    /// follow their node. Empty, with a warning, if nothing can be drawn.
    nlohmann::json primitivesOf(const osg::Geometry& geometry, const osg::StateSet& state, const SkinPlaces* skin);

private:
    using Attributes = nlohmann::json;
    using Values = std::vector<float>;

    template <typename Make>
    void add(Attributes& to, const char* name, const osg::Array* array, std::size_t vertices, std::size_t components,
             Make make);
    Attributes attributesOf(const osg::Geometry& geometry, const osg::StateSet& state, bool hasColors);
    void addInfluences(const SkinnedGeometry& mesh, const SkinPlaces& skin, Attributes& to);
    nlohmann::json targetsOf(const SkinnedGeometry& mesh, const Attributes& base);
    nlohmann::json mappingsOf(const osg::Geometry& geometry, unsigned int coordinates);
    Values finite(Values values);

    GlbWriter& _writer;
    MaterialWriter _materials;
    const std::vector<std::string>& _variants;
    Report& _report;
    std::string _label; ///< of the drawable that is being written, for messages
    /// by array, number of vertices and name; none: the array cannot be written
    std::map<std::tuple<const osg::Array*, std::size_t, std::string>, std::optional<std::size_t>> _accessors;
    std::map<std::tuple<const osg::Array*, const osg::Array*, SkinPlaces, std::size_t>, Attributes> _influences;
};

} // namespace osgGpuAnimation::gltf
