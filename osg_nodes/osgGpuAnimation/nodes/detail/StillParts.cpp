// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/detail/StillParts.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <layout.glsl>

#include <osg/FrontFace>
#include <osg/LOD>
#include <osg/Material>
#include <osg/Notify>
#include <osg/UserDataContainer>
#include <osg/ValueObject>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace osgGpuAnimation
{

namespace
{

const char* const jointKey = "osgGpuAnimation.stillJoint";
const osg::Vec4 white(1, 1, 1, 1);

double determinantOf(const osg::Matrixd& matrix)
{
    return glm::determinant(glm::dmat3(glm::make_mat4(matrix.ptr())));
}

/// From the space that getFileToNode() leads to, to that of the joint at rest; none if the joint flattens.
std::optional<osg::Matrixd> nodeToJoint(const AnimatedCharacter& character, int joint)
{
    const AnimationSet& set = character.getAnimationSet();
    std::vector<AffineMatrix> jointToModel;
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), jointToModel);
    const osg::Matrixd jointToNode = toOsg(jointToModel[static_cast<std::size_t>(joint)]) * character.getFileToNode();
    if (determinantOf(jointToNode) == 0.0) return std::nullopt;
    return osg::Matrixd::inverse(jointToNode);
}

bool hasOwnColors(const osg::Geometry& geometry)
{
    return geometry.getColorArray() && geometry.getColorArray()->getBinding() == osg::Array::BIND_PER_VERTEX;
}

/// Visits all paths to still meshes.
class StillPartVisitor : public SceneVisitor
{
public:
    using SceneVisitor::apply;

    StillPartVisitor(osg::Group& crowd, unsigned short entry, const osg::Matrixd& nodeToEntry)
        : SceneVisitor(Shared::EachPath, TRAVERSE_ALL_CHILDREN), _crowd(crowd), _entry(entry), _nodeToEntry(nodeToEntry)
    {
        setNodeMaskOverride(~0u); // a mesh that is hidden now may be shown later
    }

    void apply(osg::LOD& lod) override
    {
        for (unsigned int level = 0; level < lod.getNumChildren(); ++level)
            if (lod.getMaxRange(level) == std::numeric_limits<float>::max()) lod.getChild(level)->accept(*this);
    }
    void apply(osg::Geometry& geometry) override;

    bool hasAdded = false;
    std::size_t leftOut = 0; ///< meshes

private:
    osg::StateSet* stateOf(const osg::Geometry& geometry);

    using StateKey = std::tuple<const osg::StateSet*, const osg::FrontFace*, bool>; ///< bool: colours of each vertex

    osg::Group& _crowd;
    const unsigned short _entry;
    const osg::Matrixd _nodeToEntry;
    std::size_t _vertices = 0;
    std::map<StateKey, osg::ref_ptr<osg::StateSet>> _states;
};

/// The innermost winding of the present path; null: none.
const osg::FrontFace* windingOf(const osg::NodePath& path)
{
    const osg::FrontFace* winding = nullptr;
    for (const osg::Node* node : path)
    {
        const osg::StateSet* const state = node->getStateSet();
        const osg::StateAttribute* const own = state ? state->getAttribute(osg::StateAttribute::FRONTFACE) : nullptr;
        if (own) winding = static_cast<const osg::FrontFace*>(own);
    }
    return winding;
}

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

osg::StateSet* StillPartVisitor::stateOf(const osg::Geometry& geometry)
{
    const osg::FrontFace* const winding = windingOf(getNodePath());
    const bool isColored = hasOwnColors(geometry);
    osg::ref_ptr<osg::StateSet>& state = _states[{geometry.getStateSet(), winding, isColored}];
    if (state) return state;
    state = geometry.getStateSet() ? osg::clone(geometry.getStateSet(), osg::CopyOp::SHALLOW_COPY) : new osg::StateSet;
    if (isColored) removeBaseColor(*state);
    if (winding) state->setAttributeAndModes(const_cast<osg::FrontFace*>(winding));
    // What only the fixed pipeline and the surface program read.
    state->removeAttribute(osg::StateAttribute::ALPHAFUNC);
    state->removeMode(GL_NORMALIZE);
    state->removeDefine("POSE_COLORED");
    applyCharacterProgram(*state);
    applySkinDefines(*state, 1, false);
    return state;
}

void transformPoints(osg::Vec3Array& points, const osg::Matrixd& matrix)
{
    for (osg::Vec3& point : points)
        point = osg::Vec3(osg::Vec3d(point) * matrix);
}

/// As the inverse transpose does.
void transformNormals(osg::Vec3Array& normals, const osg::Matrixd& inverse)
{
    for (osg::Vec3& normal : normals)
    {
        osg::Vec3d turned = osg::Matrixd::transform3x3(inverse, osg::Vec3d(normal));
        turned.normalize();
        normal = osg::Vec3(turned);
    }
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
    const osg::Matrixd inverse = osg::Matrixd::inverse(matrix);
    mesh.setVertexArray(transformedCopy<osg::Vec3Array>(mesh.getVertexArray(), [&](osg::Vec3Array& points)
                                                        { transformPoints(points, matrix); }));
    mesh.setNormalArray(transformedCopy<osg::Vec3Array>(mesh.getNormalArray(), [&](osg::Vec3Array& normals)
                                                        { transformNormals(normals, inverse); }));
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

void StillPartVisitor::apply(osg::Geometry& geometry)
{
    const std::size_t vertices = geometry.getVertexArray() ? geometry.getVertexArray()->getNumElements() : 0;
    const osg::Matrixd toEntry = osg::computeLocalToWorld(getNodePath()) * _nodeToEntry;
    if (vertices > StillParts::maxVertices - _vertices || determinantOf(toEntry) == 0.0)
    {
        ++leftOut;
        return;
    }
    _vertices += vertices;
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    const std::string& nodeName = getNodePath()[getNodePath().size() - 2]->getName();
    mesh->setName(nodeName.empty() ? meshNameOf(geometry) : nodeName);
    setMeshName(*mesh, meshNameOf(geometry));
    mesh->setNodeMask(maskOf(getNodePath()));
    mesh->setVertexArray(geometry.getVertexArray());
    mesh->setNormalArray(geometry.getNormalArray());
    for (unsigned int unit = 0; unit < geometry.getNumTexCoordArrays(); ++unit)
        mesh->setTexCoordArray(unit, geometry.getTexCoordArray(unit));
    for (unsigned int location = 0; location < geometry.getNumVertexAttribArrays(); ++location)
        mesh->setVertexAttribArray(location, geometry.getVertexAttribArray(location));
    osg::ref_ptr<osg::Array> colors = geometry.getColorArray();
    if (!hasOwnColors(geometry)) colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1, &white);
    mesh->setColorArray(colors);
    mesh->setPrimitiveSetList(geometry.getPrimitiveSetList());
    if (toEntry != osg::Matrixd()) transform(*mesh, toEntry);
    mesh->setRigidEntry(_entry);
    mesh->setStateSet(stateOf(geometry));
    _crowd.addChild(mesh);
    hasAdded = true;
}

} // namespace

void StillParts::set(AnimatedCharacter& character, osg::Group& group, int joint)
{
    group.setUserValue(jointKey, joint);
    character.getOrCreateUserDataContainer()->addUserObject(&group);
}

osg::Group* StillParts::of(const AnimatedCharacter& character)
{
    const osg::UserDataContainer* const objects = character.getUserDataContainer();
    int joint = -1;
    for (unsigned int i = 0; objects && i < objects->getNumUserObjects(); ++i)
    {
        const auto* group = dynamic_cast<const osg::Group*>(objects->getUserObject(i));
        if (group && group->getUserValue(jointKey, joint)) return const_cast<osg::Group*>(group);
    }
    return nullptr;
}

bool StillParts::addTo(osg::Group& crowd, const AnimatedCharacter& character)
{
    osg::Group* const group = of(character);
    if (!group) return false;
    int joint = -1;
    group->getUserValue(jointKey, joint);
    const AnimationSet& set = character.getAnimationSet(); // a stored scene may hold any
    const bool isJoint = joint >= 0 && static_cast<std::size_t>(joint) < set.skeleton().jointCount();
    const int entry = isJoint ? set.entryOfRigidJoint(joint) : -1;
    const std::optional<osg::Matrixd> toEntry = entry >= 0 ? nodeToJoint(character, joint) : std::nullopt;
    const auto warn = [&](const std::string& parts, const std::string& why)
    {
        OSG_WARN << "osgGpuAnimation: \"" << character.getName() << "\": " << parts
                 << " that do not move are left out of the crowd: " << why << std::endl;
    };
    if (!toEntry)
    {
        warn("meshes", "no joint at rest places them");
        return false;
    }
    StillPartVisitor visitor(crowd, static_cast<unsigned short>(entry), *toEntry);
    group->accept(visitor);
    if (visitor.leftOut > 0)
        warn(std::to_string(visitor.leftOut) + " meshes",
             "they flatten, or have more than " + std::to_string(maxVertices) + " vertices in all");
    return visitor.hasAdded;
}

} // namespace osgGpuAnimation
