// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PosedMesh.h>

namespace osgGpuAnimation
{

PosedMesh::PosedMesh(const SkinnedGeometry& mesh, osg::Vec3Array* positions, std::optional<std::uint64_t> instance)
    : _mesh(&mesh), _instance(instance)
{
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setName(mesh.getName());
    setVertexArray(positions);
    setTexCoordArrayList(mesh.getTexCoordArrayList());
    setPrimitiveSetList(mesh.getPrimitiveSetList());
    // The state is looked at for textures; it is the mesh's own and stays as it is.
    setStateSet(const_cast<osg::StateSet*>(mesh.getStateSet()));
}

} // namespace osgGpuAnimation
