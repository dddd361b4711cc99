// SPDX-License-Identifier: MIT
#include "gltf/export/GeometryWriter.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/mesh/geometry/PrimitiveRange.h>

#include <layout.glsl>

#include <osg/Material>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using nlohmann::json;

template <typename Array>
bool appendNumbers(const osg::Array& array, std::size_t components, float scale, std::vector<float>& out)
{
    const auto* const elements = dynamic_cast<const Array*>(&array);
    if (!elements) return false;
    out.reserve(elements->size() * components);
    for (const auto& element : *elements)
        for (std::size_t i = 0; i < components; ++i)
            out.push_back(i < element.num_components ? static_cast<float>(element[static_cast<int>(i)]) * scale
                          : i == 3                   ? 1.0f
                                                     : 0.0f);
    return true;
}

/// By vertex; of components that the array lacks, the fourth is 1, others are 0. Empty: an array of another kind.
std::vector<float> numbersOf(const osg::Array* array, std::size_t components)
{
    std::vector<float> numbers;
    if (!array) return numbers;
    static_cast<void>(appendNumbers<osg::Vec2Array>(*array, components, 1.0f, numbers) ||
                      appendNumbers<osg::Vec3Array>(*array, components, 1.0f, numbers) ||
                      appendNumbers<osg::Vec4Array>(*array, components, 1.0f, numbers) ||
                      appendNumbers<osg::Vec2dArray>(*array, components, 1.0f, numbers) ||
                      appendNumbers<osg::Vec3dArray>(*array, components, 1.0f, numbers) ||
                      appendNumbers<osg::Vec4dArray>(*array, components, 1.0f, numbers) ||
                      appendNumbers<osg::Vec4ubArray>(*array, components, 1.0f / 255.0f, numbers) ||
                      appendNumbers<osg::Vec3ubArray>(*array, components, 1.0f / 255.0f, numbers));
    return numbers;
}

/// False: 0 is written in its place, as the import would refuse it.
bool isWritten(float number)
{
    return std::abs(number) <= TransformBound::maxNumber;
}

bool isOfEachVertex(const osg::Array* array, std::size_t vertices)
{
    return array && array->getBinding() == osg::Array::BIND_PER_VERTEX && array->getNumElements() >= vertices;
}

/// First three components of each element; a vector of length 0 becomes +Z.
void normalize(std::vector<float>& numbers, std::size_t components)
{
    for (std::size_t at = 0; at + 2 < numbers.size(); at += components)
    {
        osg::Vec3d vector(numbers[at], numbers[at + 1], numbers[at + 2]);
        if (!(vector.normalize() > 0.0)) vector.set(0.0, 0.0, 1.0);
        for (int i = 0; i < 3; ++i)
            numbers[at + static_cast<std::size_t>(i)] = static_cast<float>(vector[i]);
    }
}

/// The kit stores colours as displayed, glTF linear ones in [0, 1].
osg::Vec4 writtenColor(const osg::Vec4& display)
{
    osg::Vec4 color;
    for (int i = 0; i < 4; ++i)
        color[i] = std::clamp(display[i], 0.0f, 1.0f);
    return linearColor(color);
}

void appendColor(const osg::Vec4& color, std::vector<float>& out)
{
    out.insert(out.end(), {color.x(), color.y(), color.z(), color.w()});
}

/// The displayed colour of a vertex; white if there is none. colors: four numbers each, one for all or for each vertex.
osg::Vec4 colorOf(const std::vector<float>& colors, bool isOfEach, std::size_t vertex)
{
    const std::size_t at = isOfEach ? 4 * vertex : 0;
    if (at + 3 >= colors.size()) return osg::Vec4(1, 1, 1, 1);
    return osg::Vec4(colors[at], colors[at + 1], colors[at + 2], colors[at + 3]);
}

/// Two of the components of each element; glTF counts v from the top.
std::vector<float> textureCoordinatesOf(const osg::Array& array, std::size_t components, std::size_t first)
{
    const std::vector<float> all = numbersOf(&array, components);
    std::vector<float> numbers;
    for (std::size_t at = first; at + 1 < all.size(); at += components)
        numbers.insert(numbers.end(), {all[at], 1.0f - all[at + 1]});
    return numbers;
}

/// True if the vertices' colours are shown, and whether they replace the material's (the fixed pipeline) or multiply it
/// (the character program).
struct ColorUse
{
    bool isShown = false;
    bool isInPlaceOfMaterial = false;
};

ColorUse colorUseOf(const osg::Geometry& geometry, const osg::StateSet& state)
{
    const auto* const mesh = dynamic_cast<const SkinnedGeometry*>(&geometry);
    if (mesh) return {mesh->getColors() != SkinnedGeometry::Colors::White, false};
    const osg::Array* const colors = geometry.getColorArray();
    if (!colors || colors->getBinding() <= osg::Array::BIND_OFF) return {};
    const auto* const material = dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL));
    const bool isShown = !material || material->getColorMode() != osg::Material::OFF;
    return {isShown, isShown};
}

/// A list of indices with glTF's mode, which is GL's number.
struct IndexedPart
{
    int mode = GL_TRIANGLES;
    std::vector<std::uint32_t> indices;
};

bool isOfTriangles(GLenum mode)
{
    return mode >= GL_TRIANGLES && mode <= GL_POLYGON;
}

/// The numbers of indices that a set draws one after the other.
std::vector<unsigned int> runsOf(const osg::PrimitiveSet& set)
{
    const auto* const lengths = dynamic_cast<const osg::DrawArrayLengths*>(&set);
    if (!lengths) return {set.getNumIndices()};
    return {lengths->begin(), lengths->end()};
}

/// Appends the triangles of a run; osg::TriangleIndexFunctor reads beyond incomplete ones.
template <typename At>
void appendTriangles(GLenum mode, unsigned int count, At at, std::vector<std::uint32_t>& out)
{
    const auto add = [&](unsigned int a, unsigned int b, unsigned int c) {
        out.insert(out.end(), {at(a), at(b), at(c)});
    };
    const bool isOfQuads = mode == GL_QUADS || mode == GL_QUAD_STRIP;
    const unsigned int step = mode == GL_TRIANGLES ? 3 : mode == GL_QUADS ? 4 : mode == GL_QUAD_STRIP ? 2 : 1;
    for (unsigned int last = isOfQuads ? 3 : 2; last < count; last += step)
    {
        if (mode == GL_TRIANGLE_FAN || mode == GL_POLYGON)
            add(0, last - 1, last);
        else if (mode == GL_TRIANGLE_STRIP && last % 2 != 0)
            add(last - 2, last, last - 1);
        else if (!isOfQuads)
            add(last - 2, last - 1, last);
        else
        {
            add(last - 3, last - 2, last - 1);
            mode == GL_QUADS ? add(last - 3, last - 1, last) : add(last - 2, last, last - 1);
        }
    }
}

/// Appends the lines of a strip or loop.
template <typename At>
void appendLines(GLenum mode, unsigned int count, At at, std::vector<std::uint32_t>& out)
{
    for (unsigned int last = 1; last < count; ++last)
        out.insert(out.end(), {at(last - 1), at(last)});
    if (mode == GL_LINE_LOOP && count > 1) out.insert(out.end(), {at(count - 1), at(0)});
}

/// A list for triangles, then one for each other set. outFault: why a set is left out; null: none is.
std::vector<IndexedPart> partsOf(const osg::Geometry& geometry, std::size_t vertices, const char*& outFault)
{
    constexpr std::size_t maxIndices = std::size_t(1) << 27; // sets that overlap may have any number
    outFault = nullptr;
    std::vector<IndexedPart> parts(1);
    std::size_t indices = 0;
    for (unsigned int number = 0; number < geometry.getNumPrimitiveSets(); ++number)
    {
        const osg::PrimitiveSet* const set = geometry.getPrimitiveSet(number);
        if (!isWithin(set, vertices) || indices + set->getNumIndices() > maxIndices)
        {
            outFault = set ? "indices beyond its vertices, or too few; a part is left out"
                           : "a primitive set is missing; left out";
            continue;
        }
        indices += set->getNumIndices();
        const GLenum mode = set->getMode();
        if (!isOfTriangles(mode) && mode >= GL_TRIANGLES) continue;
        const std::vector<unsigned int> runs = runsOf(*set);
        const bool areStrips = runs.size() > 1 && (mode == GL_LINE_STRIP || mode == GL_LINE_LOOP);
        IndexedPart own{static_cast<int>(areStrips ? GL_LINES : mode), {}};
        unsigned int first = 0;
        for (const unsigned int count : runs)
        {
            const auto at = [&](unsigned int i) { return static_cast<std::uint32_t>(set->index(first + i)); };
            if (isOfTriangles(mode))
                appendTriangles(mode, count, at, parts.front().indices);
            else if (areStrips)
                appendLines(mode, count, at, own.indices);
            else
                for (unsigned int i = 0; i < count; ++i)
                    own.indices.push_back(at(i));
            first += count;
        }
        if (own.mode == GL_LINES) own.indices.resize(own.indices.size() / 2 * 2); // without an incomplete line
        if (!own.indices.empty()) parts.push_back(std::move(own));
    }
    return parts;
}

bool isDrawable(const IndexedPart& part)
{
    const std::size_t min = part.mode == GL_POINTS ? 1 : part.mode == GL_TRIANGLES ? 3 : 2;
    return part.indices.size() >= min;
}

} // namespace

GeometryWriter::Values GeometryWriter::finite(Values values)
{
    bool isFinite = true;
    for (float& value : values)
        if (!isWritten(value))
        {
            isFinite = false;
            value = 0.0f;
        }
    if (!isFinite) _report.warn(_label + ": numbers that are not finite or beyond 1e18 are written as 0");
    return values;
}

/// make: the values, of a new accessor; further ones than those of the vertices are cut off. Nothing is added, with a
/// warning, if there are fewer.
template <typename Make>
void GeometryWriter::add(Attributes& to, const char* name, const osg::Array* array, std::size_t vertices,
                         std::size_t components, Make make)
{
    const auto [place, isNew] = _accessors.try_emplace({array, vertices, std::string(name)});
    if (isNew)
    {
        Values values = make();
        if (values.size() < vertices * components)
            _report.warn(_label + ": " + name + " is an array of a kind that is not read (" + array->className() +
                         "); left out");
        else
        {
            values.resize(vertices * components);
            const std::string type = "VEC" + std::to_string(components);
            place->second = _writer.addFloats(finite(std::move(values)), type.c_str(), GlbWriter::Use::Vertices);
        }
    }
    if (place->second) to[name] = *place->second;
}

GeometryWriter::Attributes GeometryWriter::attributesOf(const osg::Geometry& geometry, const osg::StateSet& state,
                                                        bool hasColors)
{
    Attributes made = json::object();
    const osg::Array* const positions = geometry.getVertexArray();
    const std::size_t vertices = positions->getNumElements();
    add(made, "POSITION", positions, vertices, 3, [&] { return numbersOf(positions, 3); });
    const auto addUnit = [&](const char* name, const osg::Array* array, std::size_t components)
    {
        const auto make = [&]
        {
            Values numbers = finite(numbersOf(array, components));
            normalize(numbers, components);
            for (std::size_t at = 3; components == 4 && at < numbers.size(); at += 4)
                numbers[at] = numbers[at] < 0.0f ? -1.0f : 1.0f;
            return numbers;
        };
        add(made, name, array, vertices, components, make);
    };
    const osg::Array* const normals = geometry.getNormalArray();
    if (isOfEachVertex(normals, vertices) && !hasTrueUniform(state, "flatNormals")) addUnit("NORMAL", normals, 3);
    const osg::Array* const tangents = geometry.getVertexAttribArray(POSE_TANGENT_LOCATION);
    if (isOfEachVertex(tangents, vertices) && made.contains("NORMAL")) addUnit("TANGENT", tangents, 4);
    const osg::Array* const coordinates = geometry.getTexCoordArray(0);
    if (isOfEachVertex(coordinates, vertices))
        add(made, "TEXCOORD_0", coordinates, vertices, 2,
            [&]
            { return textureCoordinatesOf(*coordinates, std::min<std::size_t>(coordinates->getDataSize(), 4), 0); });
    const osg::Array* const more = geometry.getVertexAttribArray(POSE_COORDINATES_LOCATION);
    if (isOfEachVertex(more, vertices) && made.contains("TEXCOORD_0"))
    {
        add(made, "TEXCOORD_1", more, vertices, 2, [&] { return textureCoordinatesOf(*more, 4, 0); });
        add(made, "TEXCOORD_2", more, vertices, 2, [&] { return textureCoordinatesOf(*more, 4, 2); });
    }
    if (!hasColors) return made;
    const osg::Array* const colors = geometry.getColorArray();
    const Values display = numbersOf(colors, 4);
    if (colors && display.empty())
        _report.warn(_label + ": COLOR_0 is an array of a kind that is not read (" + colors->className() +
                     "); written as white");
    Values written;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
        appendColor(writtenColor(colorOf(display, isOfEachVertex(colors, vertices), vertex)), written);
    made["COLOR_0"] = _writer.addFloats(finite(std::move(written)), "VEC4", GlbWriter::Use::Vertices);
    return made;
}

void GeometryWriter::addInfluences(const SkinnedGeometry& mesh, const SkinPlaces& skin, Attributes& to)
{
    const std::size_t sets = mesh.getInfluenceCount() > 4 ? 2 : 1;
    const std::size_t vertices = mesh.getVertexCount();
    const int rigid = mesh.getRigidEntry();
    const auto [known, isNew] = _influences.try_emplace(
        {rigid < 0 ? mesh.getEntries(0) : nullptr, mesh.getWeights(0), skin, rigid < 0 ? 0 : vertices});
    if (!isNew) return to.update(known->second);
    std::vector<std::vector<std::uint16_t>> joints(sets, std::vector<std::uint16_t>(4 * vertices));
    std::vector<Values> weights(sets, Values(4 * vertices));
    std::size_t mended = 0;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
    {
        // A joint occurs once a vertex, with a weight above 0, and the weights sum to 1 (glTF 2.0, section 3.7.3.3).
        std::vector<std::pair<std::uint16_t, double>> influences;
        double sum = 0.0;
        const auto addTo = [&](std::size_t entry, float weight)
        {
            const auto place = skin.find(entry);
            if (place == skin.end() || !(weight > 0.0f) || !std::isfinite(weight)) return;
            const auto same = std::find_if(influences.begin(), influences.end(),
                                           [&](const auto& each) { return each.first == place->second; });
            if (same == influences.end())
                influences.emplace_back(place->second, weight);
            else
                same->second += weight;
            sum += weight;
        };
        mesh.forEachInfluence(vertex, addTo);
        if (std::abs(sum - 1.0) > 1e-4) ++mended;
        if (influences.empty())
        {
            influences.emplace_back(std::uint16_t(0), 1.0);
            sum = 1.0;
        }
        for (std::size_t i = 0; i < std::min(influences.size(), 4 * sets); ++i)
        {
            joints[i / 4][4 * vertex + i % 4] = influences[i].first;
            weights[i / 4][4 * vertex + i % 4] = static_cast<float>(influences[i].second / sum);
        }
    }
    if (mended > 0)
        _report.warn(_label + ": the weights of " + std::to_string(mended) +
                     " vertices do not sum to 1; they are scaled");
    known->second = json::object();
    for (std::size_t set = 0; set < sets; ++set)
    {
        known->second["JOINTS_" + std::to_string(set)] = _writer.addJoints(joints[set]);
        known->second["WEIGHTS_" + std::to_string(set)] =
            _writer.addFloats(weights[set], "VEC4", GlbWriter::Use::Vertices);
    }
    to.update(known->second);
}

json GeometryWriter::targetsOf(const SkinnedGeometry& mesh, const Attributes& base)
{
    json made = json::array();
    const std::size_t vertices = mesh.getVertexCount();
    const Values display = numbersOf(mesh.getColorArray(), 4);
    const bool isColored = isOfEachVertex(mesh.getColorArray(), vertices);
    for (const MorphTarget& target : mesh.getMorphTargets())
    {
        Attributes deltas = json::object();
        const auto addVectors = [&](const char* name, const osg::Vec3Array* array)
        {
            if (array && array->size() == vertices && base.contains(name))
                add(deltas, name, array, vertices, 3, [&] { return numbersOf(array, 3); });
        };
        addVectors("POSITION", target.positions);
        addVectors("NORMAL", target.normals);
        addVectors("TANGENT", target.tangents);
        if (target.textureCoordinates && target.textureCoordinates->size() == vertices && base.contains("TEXCOORD_0"))
            add(deltas, "TEXCOORD_0", target.textureCoordinates, vertices, 2,
                [&]
                {
                    Values numbers = numbersOf(target.textureCoordinates, 2);
                    for (std::size_t at = 1; at < numbers.size(); at += 2)
                        numbers[at] = -numbers[at];
                    return numbers;
                });
        if (target.colors && target.colors->size() == vertices && base.contains("COLOR_0"))
        {
            Values written;
            for (std::size_t vertex = 0; vertex < vertices; ++vertex)
            {
                const osg::Vec4 own = colorOf(display, isColored, vertex);
                appendColor(writtenColor(own + (*target.colors)[static_cast<unsigned int>(vertex)]) - writtenColor(own),
                            written);
            }
            deltas["COLOR_0"] = _writer.addFloats(finite(std::move(written)), "VEC4", GlbWriter::Use::Vertices);
        }
        if (deltas.empty()) // a target has at least one attribute
            deltas["POSITION"] = _writer.addFloats(Values(3 * vertices), "VEC3", GlbWriter::Use::Vertices);
        made.push_back(std::move(deltas));
    }
    return made;
}

json GeometryWriter::mappingsOf(const osg::Geometry& geometry, unsigned int coordinates)
{
    std::map<std::size_t, json> variantsOfMaterial;
    const osg::StateSet* const own = variantState(geometry, "");
    for (std::size_t variant = 0; own && variant < _variants.size(); ++variant)
    {
        const osg::StateSet* const state = variantState(geometry, _variants[variant]);
        if (state && state != own)
            variantsOfMaterial[_materials.materialOf(*state, coordinates, false)].push_back(variant);
    }
    json mappings = json::array();
    for (auto& [material, variants] : variantsOfMaterial)
        mappings.push_back({{"material", material}, {"variants", std::move(variants)}});
    return mappings;
}

json GeometryWriter::primitivesOf(const osg::Geometry& geometry, const osg::StateSet& state, const SkinPlaces* skin)
{
    json primitives = json::array();
    if (_writer.isFull()) return primitives; // GlbWriter::glb() refuses it
    _label = "mesh " + quoted(meshNameOf(geometry));
    const osg::Array* const positions = geometry.getVertexArray();
    const std::size_t vertices = positions ? positions->getNumElements() : 0;
    if (vertices == 0 || numbersOf(positions, 3).empty())
    {
        _report.warn(_label + ": it has no vertices; left out");
        return primitives;
    }
    const auto* const mesh = dynamic_cast<const SkinnedGeometry*>(&geometry);
    const ColorUse colors = colorUseOf(geometry, state);
    Attributes attributes = attributesOf(geometry, state, colors.isShown);
    if (!attributes.contains("POSITION")) return primitives; // add() warned
    if (mesh && skin) addInfluences(*mesh, *skin, attributes);
    unsigned int coordinates = 0;
    for (unsigned int number = 0; number < 3; ++number)
        if (attributes.contains("TEXCOORD_" + std::to_string(number))) coordinates |= 1u << number;
    const osg::StateSet* const unchanged = mesh ? variantState(geometry, "") : nullptr;
    json common{
        {"attributes", attributes},
        {"material", _materials.materialOf(unchanged ? *unchanged : state, coordinates, colors.isInPlaceOfMaterial)}};
    if (mesh && !mesh->getMorphTargets().empty()) common["targets"] = targetsOf(*mesh, attributes);
    if (json mappings = mappingsOf(geometry, coordinates); !mappings.empty())
    {
        common["extensions"]["KHR_materials_variants"]["mappings"] = std::move(mappings);
        _writer.useExtension("KHR_materials_variants");
    }
    const char* fault = nullptr;
    for (const IndexedPart& part : partsOf(geometry, vertices, fault))
    {
        if (part.indices.empty()) continue;
        if (!isDrawable(part))
        {
            fault = "indices beyond its vertices, or too few; a part is left out";
            continue;
        }
        json primitive = common;
        primitive["mode"] = part.mode;
        primitive["indices"] = _writer.addIndices(part.indices);
        primitives.push_back(std::move(primitive));
    }
    if (fault) _report.warn(_label + ": " + fault);
    return primitives;
}

} // namespace osgGpuAnimation::gltf
