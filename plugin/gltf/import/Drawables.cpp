// SPDX-License-Identifier: MIT
#include "gltf/import/Drawables.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/data/MaterialVariants.h"
#include "gltf/import/Influences.h"

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>

#include <layout.glsl>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t bytesADrawable = 1024;
constexpr std::size_t bytesAVisibility = 32; // a node's number as text, and as a number
constexpr std::size_t bytesAVariant = 4096;  // an osg::StateSet with a material's attributes and uniforms
constexpr std::size_t bytesAnInfluencedVertex =
    SkinnedGeometry::maxInfluenceSets * (sizeof(osg::Vec4us) + sizeof(osg::Vec4));
// A limit for each target. Drawables share the packed targets, but each computes its bounds vertex by vertex.
constexpr std::size_t bytesAMorphedVertex = 4 * sizeof(osg::Vec4);

} // namespace

Drawables::Drawables(const tinygltf::Model& model, const NodeTree& tree, std::shared_ptr<const AnimationSet> set,
                     Meshes& meshes, Materials& materials, int variant, MemoryBudget& budget, Report& report)
    : _model(model), _tree(tree), _set(std::move(set)), _meshes(meshes), _materials(materials),
      _variants(variantNames(model)), _variant(variant), _budget(budget), _report(report)
{
    if (_set) _entries = boundsOfEntries(*_set);
    std::map<std::vector<int>, int> skins;
    for (std::size_t skin = 0; _set && skin < _set->skins().size(); ++skin)
        _firstAlike.push_back(skins.try_emplace(_set->entriesOfSkin(skin), static_cast<int>(skin)).first->second);
}

osg::Geometry* Drawables::drawable(const DrawablePlace& place)
{
    const auto [known, isNew] = _drawables.try_emplace(place);
    if (isNew) known->second = make(place);
    return known->second.get();
}

/// The character program multiplies vertex colour and material. The fixed pipeline uses one of them, so vertices of
/// plain geometry store the product.
void Drawables::setColors(osg::Geometry& geometry, const MeshPrimitive& mesh, int material, bool palette)
{
    const osg::Vec4 white(1, 1, 1, 1);
    if (!mesh.colors)
    {
        const osg::Vec4 color = palette ? white : _materials.plainColor(white, material);
        osg::ref_ptr<osg::Vec4Array>& colors = _overall[color];
        if (!colors) colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1, &color);
        geometry.setColorArray(colors);
        return;
    }
    osg::ref_ptr<osg::Vec4Array> colors = mesh.colors;
    if (!palette && _materials.baseColor(material) != white)
    {
        colors = new osg::Vec4Array(*mesh.colors);
        for (osg::Vec4& color : *colors)
            color = _materials.plainColor(color, material);
    }
    geometry.setColorArray(colors, osg::Array::BIND_PER_VERTEX);
}

void Drawables::setInfluences(SkinnedGeometry& geometry, const MeshPrimitive& mesh, const DrawablePlace& place)
{
    if (place.skin < 0)
    {
        geometry.setRigidEntry(static_cast<unsigned short>(_set->entryOfRigidJoint(place.joint)));
        return;
    }
    const tinygltf::Primitive& source = elementOf(elementOf(_model.meshes, place.mesh).primitives, place.primitive);
    const std::vector<InfluenceSet> sets =
        readInfluences(_model, source, mesh, *_set, static_cast<std::size_t>(place.skin), _report);
    for (unsigned int i = 0; i < sets.size(); ++i)
        geometry.setInfluences(i, sets[i].entries, sets[i].weights);
}

/// An upper bound of a vertex's distance from the origin under joints and morph targets; without them, in the mesh's
/// space.
double Drawables::maxDistanceOf(const DrawablePlace& place, const MeshPrimitive& mesh) const
{
    double radius = mesh.radius;
    const std::vector<WeightRange> weights =
        place.morph < 0 ? std::vector<WeightRange>() : weightRanges(*_set, static_cast<std::size_t>(place.morph));
    for (std::size_t target = 0; target < std::min(weights.size(), mesh.targetRadii.size()); ++target)
        radius += mesh.targetRadii[target] * std::max(std::abs(static_cast<double>(weights[target].min)),
                                                      std::abs(static_cast<double>(weights[target].max)));
    if (place.skin < 0 && place.joint < 0) return radius;
    TransformBound reach{0.0, 0.0};
    if (place.joint >= 0) reach = elementOf(_entries, _set->entryOfRigidJoint(place.joint));
    if (place.skin >= 0)
        for (const int entry : _set->entriesOfSkin(static_cast<std::size_t>(place.skin)))
            reach.add(elementOf(_entries, entry));
    return reach.of(radius);
}

osg::ref_ptr<osg::Geometry> Drawables::make(const DrawablePlace& place)
{
    const MeshPrimitive* mesh = meshPrimitive(place);
    if (!mesh) return nullptr;
    if (!(maxDistanceOf(place, *mesh) <= TransformBound::maxNumber))
    {
        _report.warn(mesh->label + ": its vertices lie " + outOfRangeText() + "; not drawn");
        return nullptr;
    }
    const tinygltf::Mesh& sourceMesh = elementOf(_model.meshes, place.mesh);
    const tinygltf::Primitive& source = elementOf(sourceMesh.primitives, place.primitive);
    const bool palette = place.skin >= 0 || place.joint >= 0;
    const std::size_t bytesAVertex = (place.skin >= 0 ? bytesAnInfluencedVertex : 0) +
                                     (place.morph >= 0 ? mesh->targets.size() * bytesAMorphedVertex : 0);
    const std::vector<int> visibility = _tree.visibilityWith(place.visibility);
    const std::size_t bytes = mesh->positions->size() * bytesAVertex + bytesADrawable +
                              visibility.size() * bytesAVisibility + place.name.size() + sourceMesh.name.size();
    if (!_budget.take(bytes))
    {
        _report.warn(mesh->label + ": it would take " + std::to_string(bytes) + " bytes, " + _budget.limitText() +
                     "; not drawn");
        return nullptr;
    }
    osg::ref_ptr<SkinnedGeometry> skinned = palette ? new SkinnedGeometry : nullptr;
    osg::ref_ptr<osg::Geometry> geometry = palette ? skinned.get() : new osg::Geometry;
    // Where the node does not move, its transform has the name.
    if (palette) geometry->setName(place.name.empty() ? sourceMesh.name : std::string(place.name));
    setMeshName(*geometry, sourceMesh.name);
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(mesh->positions);
    if (mesh->normals) geometry->setNormalArray(mesh->normals, osg::Array::BIND_PER_VERTEX);
    if (mesh->texCoords) geometry->setTexCoordArray(0, mesh->texCoords, osg::Array::BIND_PER_VERTEX);
    if (mesh->moreCoordinates) geometry->setVertexAttribArray(POSE_COORDINATES_LOCATION, mesh->moreCoordinates);
    if (mesh->tangents) geometry->setVertexAttribArray(POSE_TANGENT_LOCATION, mesh->tangents);
    const PrimitiveMaterials materials = materialsOf(_model, source, _materials.maps());
    const int material = materials.materialIn(_variant);
    setColors(*geometry, *mesh, material, palette);
    geometry->addPrimitiveSet(mesh->primitiveSet);
    if (place.hidden || (place.visibility >= 0 && elementOf(_tree.hiddenAtRest, place.visibility)))
        geometry->setNodeMask(0);
    if (!place.hidden && !visibility.empty()) markVisibility(*geometry, visibility);
    if (palette) setInfluences(*skinned, *mesh, place);
    if (place.morph >= 0) skinned->setMorphTargets(*_set, static_cast<std::size_t>(place.morph), mesh->targets);

    MaterialUse use;
    use.palette = palette;
    use.mirrored = place.mirrored;
    use.lit = mesh->normals.valid();
    use.flat = palette && mesh->isFlat;
    use.colored = mesh->colors.valid();
    use.influences = palette ? skinned->getInfluenceCount() : 0;
    use.morphed = palette && place.morph >= 0;
    if (_materials.wantedCoordinates(material) & ~mesh->coordinates)
        _report.warn(mesh->label + ": lacks the texture coordinates that its material needs");
    geometry->setStateSet(stateSet(*mesh, use, material));
    for (const int variant : materials.withoutCoordinates)
        _report.warn(mesh->label + ": its material of variant " + quoted(elementOf(_variants, variant)) +
                     " reads other texture coordinates than its own material; it is drawn with its own");
    if (palette && !materials.ofVariant.empty()) setVariants(*skinned, *mesh, materials, use);
    return geometry;
}

/// use: all but what depends on the material.
osg::StateSet* Drawables::stateSet(const MeshPrimitive& mesh, MaterialUse use, int material)
{
    use.material = material;
    use.coordinates = mesh.coordinates & _materials.wantedCoordinates(material);
    use.tangents = mesh.tangents && _materials.hasNormalMap(material);
    return _materials.stateSet(use);
}

void Drawables::setVariants(SkinnedGeometry& geometry, const MeshPrimitive& mesh, const PrimitiveMaterials& materials,
                            const MaterialUse& use)
{
    const std::size_t bytes = materials.ofVariant.size() * bytesAVariant;
    if (!_budget.take(bytes))
        return _report.warn(mesh.label + ": its variants would take " + std::to_string(bytes) + " bytes, " +
                            _budget.limitText() + "; left out");
    std::vector<VariantState> states;
    for (const auto& [variant, material] : materials.ofVariant)
        states.push_back({elementOf(_variants, variant), stateSet(mesh, use, material)});
    setVariantStates(geometry, stateSet(mesh, use, materials.own), states);
}

} // namespace osgGpuAnimation::gltf
