// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/picking/PosedMesh.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <layout.glsl>

#include <algorithm>
#include <cstring>

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
    // Intersectors look up textures in the state and do not change it.
    setStateSet(const_cast<osg::StateSet*>(mesh.getStateSet()));
}

osg::ref_ptr<PosedMesh> PosedMeshes::of(const SkinnedGeometry& mesh, const std::shared_ptr<const AnimationSet>& set,
                                        const PoseInstruction& instruction, const AffineMatrix& rootToModel)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!holds(set, instruction, rootToModel))
    {
        _meshes.clear();
        _set = set;
        _instruction = instruction;
        _rootToModel = rootToModel;
        _masks.clear();
        for (std::size_t i = 0; i < instruction.sampleCount; ++i)
            if (auto mask = set->masks().find(instruction.samples[i].control >> POSE_SAMPLE_MASK_SHIFT))
                _masks.push_back(mask);
        Pose::evaluate(*set, instruction, rootToModel, _palette);
    }
    Posed& posed = _meshes[&mesh];
    const osg::Array* bind = mesh.getVertexArray();
    if (!posed.mesh || posed.bind != bind || (bind && posed.modifiedCount != bind->getModifiedCount()))
        pose(mesh, posed);
    return posed.mesh;
}

bool PosedMeshes::holds(const std::shared_ptr<const AnimationSet>& set, const PoseInstruction& instruction,
                        const AffineMatrix& rootToModel) const
{
    // Compares bits, so that NaN equals itself.
    const auto isGone = [](const std::weak_ptr<const SetMask>& mask) { return mask.expired(); };
    return _set == set && std::none_of(_masks.begin(), _masks.end(), isGone) &&
           _instruction.sampleCount == instruction.sampleCount &&
           std::memcmp(_instruction.samples.data(), instruction.samples.data(),
                       instruction.sampleCount * sizeof(BlendSample)) == 0 &&
           std::memcmp(&_rootToModel, &rootToModel, sizeof(AffineMatrix)) == 0;
}

void PosedMeshes::pose(const SkinnedGeometry& mesh, Posed& posed) const
{
    std::vector<glm::dvec3> computed;
    mesh.computePositions(_palette, computed);
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    positions->reserve(computed.size());
    for (const glm::dvec3& position : computed)
        positions->push_back(osg::Vec3(position.x, position.y, position.z));
    posed.mesh = new PosedMesh(mesh, positions);
    posed.bind = mesh.getVertexArray();
    posed.modifiedCount = posed.bind ? posed.bind->getModifiedCount() : 0;
}

} // namespace osgGpuAnimation
