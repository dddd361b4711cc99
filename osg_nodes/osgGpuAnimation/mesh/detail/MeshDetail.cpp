// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>

namespace osgGpuAnimation
{

namespace
{

template <typename Array>
Array* copyOf(const Array* array)
{
    return array ? osg::clone(array, osg::CopyOp::DEEP_COPY_ALL) : nullptr;
}

} // namespace

osg::ref_ptr<const SkinnedGeometry> MeshDetail::snapshot(const SkinnedGeometry& mesh)
{
    osg::ref_ptr<SkinnedGeometry> copy = new SkinnedGeometry;
    copy->setNodeMask(mesh.getNodeMask());
    copy->setInitialBound(mesh.getInitialBound());
    copy->setVertexArray(copyOf(mesh.getVertexArray()));
    copy->setNormalArray(copyOf(mesh.getNormalArray()));
    copy->setColorArray(copyOf(mesh.getColorArray()));
    if (mesh.getNumTexCoordArrays() > 0) copy->setTexCoordArray(0, copyOf(mesh.getTexCoordArray(0)));
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
        copy->getPrimitiveSetList().push_back(copyOf(primitives.get())); // may be null
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets; ++i)
        copy->setInfluences(i, copyOf(mesh.getEntries(i)), copyOf(mesh.getWeights(i)));
    if (mesh.getRigidEntry() >= 0) copy->setRigidEntry(static_cast<unsigned short>(mesh.getRigidEntry()));
    for (const MorphTarget& target : mesh.getMorphTargets())
        copy->_morphTargets.push_back({copyOf(target.positions.get()), nullptr, nullptr, nullptr});
    copy->_morph = mesh._morph;
    copy->_morphEntry = mesh._morphEntry;
    return copy;
}

} // namespace osgGpuAnimation
