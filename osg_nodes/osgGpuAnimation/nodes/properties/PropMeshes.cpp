// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/PropMeshes.h>

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <layout.glsl>

#include <osg/Geometry>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

/// Turns the first three components of each element. isNormal: by the inverse transpose.
template <typename Array>
osg::ref_ptr<osg::Array> turned(const Array& directions, const osg::Matrixd& matrix, bool isNormal)
{
    const osg::Matrixd inverse = osg::Matrixd::inverse(matrix);
    osg::ref_ptr<Array> made = osg::clone(&directions, osg::CopyOp::DEEP_COPY_ALL);
    for (auto& direction : *made)
    {
        const osg::Vec3d before(direction[0], direction[1], direction[2]);
        osg::Vec3d after = isNormal ? osg::Matrixd::transform3x3(inverse, before) // the inverse times a column
                                    : osg::Matrixd::transform3x3(before, matrix);
        after.normalize();
        for (int i = 0; i < 3; ++i)
            direction[i] = static_cast<float>(after[i]);
    }
    return made;
}

osg::ref_ptr<osg::Vec3Array> moved(const osg::Vec3Array& vertices, const osg::Matrixd& matrix)
{
    osg::ref_ptr<osg::Vec3Array> made = osg::clone(&vertices, osg::CopyOp::DEEP_COPY_ALL);
    for (osg::Vec3& vertex : *made)
        vertex = osg::Vec3d(vertex) * matrix;
    return made;
}

/// matrix: from the geometry's space to that of the palette entry's vertices.
osg::ref_ptr<SkinnedGeometry> rigidMesh(const osg::Geometry& source, const osg::Matrixd& matrix, osg::StateSet& state,
                                        unsigned short entry)
{
    const osg::ref_ptr<osg::Geometry> shared = osg::clone(&source, osg::CopyOp::SHALLOW_COPY);
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->setName(source.getName());
    mesh->setVertexArray(moved(static_cast<const osg::Vec3Array&>(*source.getVertexArray()), matrix));
    if (const auto* normals = dynamic_cast<const osg::Vec3Array*>(source.getNormalArray()))
        mesh->setNormalArray(turned(*normals, matrix, true), source.getNormalBinding() == osg::Geometry::BIND_OVERALL
                                                                 ? osg::Array::BIND_OVERALL
                                                                 : osg::Array::BIND_PER_VERTEX);
    mesh->setColorArray(shared->getColorArray());
    mesh->setTexCoordArrayList(shared->getTexCoordArrayList());
    mesh->setVertexAttribArrayList(shared->getVertexAttribArrayList());
    if (const auto* tangents = dynamic_cast<const osg::Vec4Array*>(source.getVertexAttribArray(POSE_TANGENT_LOCATION)))
        mesh->setVertexAttribArray(POSE_TANGENT_LOCATION, turned(*tangents, matrix, false),
                                   osg::Array::BIND_PER_VERTEX);
    mesh->setPrimitiveSetList(shared->getPrimitiveSetList());
    mesh->setRigidEntry(entry);
    mesh->setStateSet(&state);
    return mesh;
}

/// Makes the meshes of a prop.
class PropVisitor : public SceneVisitor
{
public:
    using SceneVisitor::apply;

    PropVisitor(const osg::Matrixd& toEntry, unsigned short entry)
        : SceneVisitor(Shared::EachPath, TRAVERSE_ACTIVE_CHILDREN), _toEntry(toEntry), _entry(entry)
    {
    }

    void apply(osg::Drawable& drawable) override
    {
        const osg::Geometry* geometry = drawable.asGeometry();
        if (!geometry || !dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray()) ||
            geometry->containsDeprecatedData())
            return;
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        for (const osg::Node* node : getNodePath())
            if (node->getStateSet())
            {
                state->merge(*node->getStateSet());
                state->setName(node->getStateSet()->getName());
            }
        applyCharacterProgram(*state);
        applySkinDefines(*state, 1, false);
        const osg::Matrixd toProp = osg::computeLocalToWorld(getNodePath(), false);
        meshes.push_back(rigidMesh(*geometry, toProp * _toEntry, *state, _entry));
        for (auto node = getNodePath().rbegin(); node != getNodePath().rend() && meshes.back()->getName().empty();
             ++node)
            meshes.back()->setName((*node)->getName());
    }

    std::vector<osg::ref_ptr<SkinnedGeometry>> meshes;

private:
    const osg::Matrixd _toEntry;
    const unsigned short _entry;
};

} // namespace

Result<std::vector<osg::ref_ptr<SkinnedGeometry>>> propMeshes(const Outfit::Prop& prop, const AnimationSet& set)
{
    const std::string subject = "the prop on joint \"" + prop.joint + "\": ";
    if (!prop.node) return Error{subject + "it has no node"};
    const Result<std::size_t> joint = set.skeleton().jointNamed(prop.joint);
    if (!joint) return Error{subject + joint.error().message};
    const auto follows = [&](const PaletteEntry& entry) { return entry.joint == static_cast<int>(joint.value()); };
    const auto entry = std::find_if(set.palette().begin(), set.palette().end(), follows);
    if (entry == set.palette().end()) return Error{subject + "it moves no mesh of the crowd"};
    if (const Result<AffineMatrix> checked = toRootMatrix(prop.toJoint, "the transform to the joint", true); !checked)
        return Error{subject + checked.error().message};
    const osg::Matrixd toEntry = prop.toJoint * osg::Matrixd::inverse(toOsg(entry->inverseBind));
    if (!toEntry.valid()) return Error{subject + "its inverse bind matrix has no inverse"};
    PropVisitor visitor(toEntry, static_cast<unsigned short>(entry - set.palette().begin()));
    prop.node->accept(visitor);
    if (visitor.meshes.empty())
        return Error{subject + "\"" + prop.node->getName() + "\" has no geometry with vertices of three floats"};
    return std::move(visitor.meshes);
}

} // namespace osgGpuAnimation
