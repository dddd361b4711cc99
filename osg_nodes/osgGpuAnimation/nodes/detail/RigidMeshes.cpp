// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/detail/RigidMeshes.h>

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <layout.glsl>

#include <osg/LOD>
#include <osg/Material>
#include <osg/UserDataContainer>
#include <osgUtil/TransformAttributeFunctor>

#include <limits>
#include <map>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

const osg::Vec4 white(1, 1, 1, 1);

bool hasOwnColors(const osg::Geometry& geometry)
{
    return geometry.getColorArray() && geometry.getColorArray()->getBinding() == osg::Array::BIND_PER_VERTEX;
}

/// Visits all paths to geometries.
class RigidMeshVisitor : public SceneVisitor
{
public:
    using SceneVisitor::apply;

    RigidMeshVisitor(unsigned short entry, const osg::Matrixd& toEntry)
        : SceneVisitor(Shared::EachPath, TRAVERSE_ALL_CHILDREN), _entry(entry), _toEntry(toEntry)
    {
        setNodeMaskOverride(~0u); // a mesh that is hidden now may be shown later
    }

    void apply(osg::LOD& lod) override
    {
        for (unsigned int level = 0; level < lod.getNumChildren(); ++level)
            if (lod.getMaxRange(level) == std::numeric_limits<float>::max()) lod.getChild(level)->accept(*this);
    }
    void apply(osg::Geometry& geometry) override;

    RigidMeshes made;

private:
    osg::StateSet* stateOf(bool hasColors);

    using StateKey =
        std::pair<std::vector<const osg::StateSet*>, bool>; ///< those of the path; bool: vertices have colours

    const unsigned short _entry;
    const osg::Matrixd _toEntry;
    std::size_t _vertices = 0;
    std::map<StateKey, osg::ref_ptr<osg::StateSet>> _states;
};

/// The colours of each vertex of a still mesh contain the base colour.
void removeBaseColor(osg::StateSet& state)
{
    if (const auto* material = dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL)))
    {
        const osg::ref_ptr<osg::Material> own = osg::clone(material, osg::CopyOp::SHALLOW_COPY);
        own->setColorMode(osg::Material::OFF);
        own->setDiffuse(osg::Material::FRONT_AND_BACK, white);
        own->setAmbient(osg::Material::FRONT_AND_BACK, white);
        state.setAttribute(own);
    }
    if (state.getUniform("baseColorFactor"))
    {
        state.removeUniform("baseColorFactor");
        state.addUniform(new osg::Uniform("baseColorFactor", white));
    }
}

/// The state of the present path, of which the kit's program draws skinned meshes.
osg::StateSet* RigidMeshVisitor::stateOf(bool hasColors)
{
    StateKey key{{}, hasColors};
    for (const osg::Node* node : getNodePath())
        if (node->getStateSet()) key.first.push_back(node->getStateSet());
    osg::ref_ptr<osg::StateSet>& state = _states[key];
    if (state) return state;
    state = new osg::StateSet;
    for (const osg::StateSet* each : key.first)
    {
        state->merge(*each);
        state->setName(each->getName());
        if (each->getUserDataContainer())
            state->setUserDataContainer(const_cast<osg::UserDataContainer*>(each->getUserDataContainer()));
    }
    if (hasColors) removeBaseColor(*state);
    // What only the fixed pipeline and the surface program read.
    state->removeAttribute(osg::StateAttribute::ALPHAFUNC);
    state->removeMode(GL_NORMALIZE);
    state->removeDefine("POSE_COLORED");
    applyCharacterProgram(*state);
    applySkinDefines(*state, 1, false);
    return state;
}

/// The fourth number is the side of the bitangent, which a mirrored mesh has on the other side.
void transformTangents(osg::Vec4Array& tangents, const osg::Matrixd& matrix)
{
    const float side = determinantOf(matrix) < 0.0 ? -1.0f : 1.0f;
    for (osg::Vec4& tangent : tangents)
    {
        osg::Vec3d turned = osg::Matrixd::transform3x3(osg::Vec3d(tangent.x(), tangent.y(), tangent.z()), matrix);
        turned.normalize();
        tangent = osg::Vec4(osg::Vec3(turned), side * tangent.w());
    }
}

/// The array itself, or a copy of it in the mesh.
template <typename Array, typename Transform>
osg::ref_ptr<osg::Array> transformedCopy(osg::Array* array, Transform transform)
{
    const auto* known = dynamic_cast<const Array*>(array);
    if (!known) return array;
    osg::ref_ptr<Array> copy = osg::clone(known, osg::CopyOp::SHALLOW_COPY);
    transform(*copy);
    return copy;
}

void transform(osg::Geometry& mesh, const osg::Matrixd& matrix)
{
    osgUtil::TransformAttributeFunctor functor(matrix);
    const auto transformed = [&](osg::Drawable::AttributeType type)
    {
        return [&functor, type](osg::Vec3Array& array)
        { functor.apply(type, array.getNumElements(), array.asVector().data()); };
    };
    mesh.setVertexArray(transformedCopy<osg::Vec3Array>(mesh.getVertexArray(), transformed(osg::Drawable::VERTICES)));
    mesh.setNormalArray(transformedCopy<osg::Vec3Array>(mesh.getNormalArray(), transformed(osg::Drawable::NORMALS)));
    osg::Array* const present = mesh.getVertexAttribArray(POSE_TANGENT_LOCATION);
    if (!present) return;
    mesh.setVertexAttribArray(POSE_TANGENT_LOCATION,
                              transformedCopy<osg::Vec4Array>(present, [&](osg::Vec4Array& tangents)
                                                              { transformTangents(tangents, matrix); }));
}

osg::Node::NodeMask maskOf(const osg::NodePath& path)
{
    osg::Node::NodeMask mask = ~0u;
    for (const osg::Node* node : path)
        mask &= node->getNodeMask();
    return mask;
}

void RigidMeshVisitor::apply(osg::Geometry& geometry)
{
    const std::size_t vertices = geometry.getVertexArray() ? geometry.getVertexArray()->getNumElements() : 0;
    const osg::Matrixd toEntry = osg::computeLocalToWorld(getNodePath()) * _toEntry;
    const bool isMesh =
        dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray()) && !geometry.containsDeprecatedData();
    if (!isMesh || vertices > RigidMeshes::maxVertices - _vertices || determinantOf(toEntry) == 0.0)
    {
        ++made.leftOut;
        return;
    }
    _vertices += vertices;
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    const std::size_t depth = getNodePath().size();
    const std::string nodeName = depth > 1 ? getNodePath()[depth - 2]->getName() : "";
    mesh->setName(nodeName.empty() ? meshNameOf(geometry) : nodeName);
    setMeshName(*mesh, meshNameOf(geometry));
    mesh->setNodeMask(maskOf(getNodePath()));
    mesh->setVertexArray(geometry.getVertexArray());
    mesh->setNormalArray(geometry.getNormalArray());
    for (unsigned int unit = 0; unit < geometry.getNumTexCoordArrays(); ++unit)
        mesh->setTexCoordArray(unit, geometry.getTexCoordArray(unit));
    for (unsigned int location = 0; location < geometry.getNumVertexAttribArrays(); ++location)
        mesh->setVertexAttribArray(location, geometry.getVertexAttribArray(location));
    osg::StateSet* const state = stateOf(hasOwnColors(geometry));
    // A single colour is that of the material, if there is one.
    osg::ref_ptr<osg::Array> colors = geometry.getColorArray();
    if (!hasOwnColors(geometry) && (!colors || state->getAttribute(osg::StateAttribute::MATERIAL)))
        colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1, &white);
    mesh->setColorArray(colors);
    mesh->setPrimitiveSetList(geometry.getPrimitiveSetList());
    if (toEntry != osg::Matrixd()) transform(*mesh, toEntry);
    mesh->setRigidEntry(_entry);
    mesh->setStateSet(state);
    made.meshes.push_back(mesh);
}

} // namespace

RigidMeshes RigidMeshes::of(osg::Node& node, unsigned short entry, const osg::Matrixd& toEntry)
{
    RigidMeshVisitor visitor(entry, toEntry);
    node.accept(visitor);
    return std::move(visitor.made);
}

} // namespace osgGpuAnimation
