// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>

#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/geometry/PrimitiveRange.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstring>

namespace osgGpuAnimation
{

namespace
{

/// Identifies the content of the pose at that place.
std::uint64_t serialOf(const PoseInstruction& instruction, std::size_t place)
{
    return instruction.poses[place] ? instruction.poses[place]->keyframe().serial() : 0;
}

osg::Vec3Array* toArray(const std::vector<glm::dvec3>& vectors)
{
    auto* array = new osg::Vec3Array;
    array->reserve(static_cast<unsigned int>(vectors.size()));
    for (const glm::dvec3& vector : vectors)
        array->push_back(osg::Vec3(osg::Vec3d(vector.x, vector.y, vector.z)));
    return array;
}

/// OSG's writer of .ac crashes on a texture without coordinates.
osg::StateSet* withoutTextures(const osg::StateSet& state)
{
    auto* result = new osg::StateSet;
    for (const auto& [type, attribute] : state.getAttributeList())
        result->setAttribute(attribute.first, attribute.second);
    result->getModeList() = state.getModeList();
    return result;
}

} // namespace

osg::ref_ptr<osg::Geometry> PosedMeshes::of(const SkinnedGeometry& mesh, const std::shared_ptr<const AnimationSet>& set,
                                            const PoseInstruction& instruction, const AffineMatrix& rootToModel,
                                            bool withNormals)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!holds(set, instruction, rootToModel))
    {
        _meshes.clear();
        _set = set;
        _instruction = instruction;
        _rootToModel = rootToModel;
        _masks.clear();
        _serials.clear();
        for (std::size_t pose = 0; pose < instruction.poses.size(); ++pose)
            _serials.push_back(serialOf(instruction, pose));
        for (std::size_t i = 0; i < instruction.sampleCount; ++i)
            if (auto mask = set->masks().find(instruction.samples[i].control >> POSE_SAMPLE_MASK_SHIFT))
                _masks.push_back(mask);
        Pose::evaluate(*set, instruction, rootToModel, _palette);
    }
    Posed& posed = _meshes[&mesh];
    const osg::Array* bind = mesh.getVertexArray();
    const unsigned int modifiedCount = bind ? bind->getModifiedCount() : 0;
    if (!posed.mesh || posed.bind != bind || posed.modifiedCount != modifiedCount || (withNormals && !posed.hasNormals))
        posed = {&mesh, pose(mesh, withNormals), bind, modifiedCount, withNormals};
    return posed.mesh;
}

bool PosedMeshes::holds(const std::shared_ptr<const AnimationSet>& set, const PoseInstruction& instruction,
                        const AffineMatrix& rootToModel) const
{
    // Compares bits, so that NaN equals itself.
    const auto isGone = [](const std::weak_ptr<const SetMask>& mask) { return mask.expired(); };
    bool hasSerials = _serials.size() == instruction.poses.size();
    for (std::size_t pose = 0; pose < _serials.size() && hasSerials; ++pose)
        hasSerials = _serials[pose] == serialOf(instruction, pose);
    return _set == set && std::none_of(_masks.begin(), _masks.end(), isGone) && hasSerials &&
           _instruction.sampleCount == instruction.sampleCount &&
           _instruction.targets.size() == instruction.targets.size() &&
           (instruction.targets.empty() || std::memcmp(_instruction.targets.data(), instruction.targets.data(),
                                                       instruction.targets.size() * sizeof(ConstraintTarget)) == 0) &&
           std::memcmp(_instruction.samples.data(), instruction.samples.data(),
                       instruction.sampleCount * sizeof(BlendSample)) == 0 &&
           std::memcmp(&_rootToModel, &rootToModel, sizeof(AffineMatrix)) == 0;
}

osg::ref_ptr<osg::Geometry> PosedMeshes::pose(const SkinnedGeometry& mesh, bool withNormals) const
{
    const osg::ref_ptr<osg::Geometry> posed = new osg::Geometry;
    posed->setUseDisplayList(false);
    posed->setUseVertexBufferObjects(false);
    posed->setName(mesh.getName());
    std::vector<glm::dvec3> computed;
    mesh.computePositions(_palette, computed);
    posed->setVertexArray(toArray(computed));
    if (withNormals)
    {
        mesh.computeNormals(_palette, computed);
        for (glm::dvec3& normal : computed)
            if (const double length = glm::length(normal); length > 0.0) normal /= length;
        if (!computed.empty()) posed->setNormalArray(toArray(computed), osg::Array::BIND_PER_VERTEX);
        posed->setColorArray(const_cast<osg::Array*>(mesh.getColorArray()));
    }
    posed->setTexCoordArrayList(mesh.getTexCoordArrayList());
    osg::Geometry::PrimitiveSetList drawn = mesh.getPrimitiveSetList();
    const std::size_t vertices = posed->getVertexArray()->getNumElements();
    drawn.erase(std::remove_if(drawn.begin(), drawn.end(), [&](const auto& set) { return !isWithin(set, vertices); }),
                drawn.end());
    posed->setPrimitiveSetList(drawn);
    // Visitors look up textures in the state and do not change it.
    posed->setStateSet(const_cast<osg::StateSet*>(mesh.getStateSet()));
    if (withNormals && posed->getStateSet() && !posed->getTexCoordArray(0))
        posed->setStateSet(withoutTextures(*posed->getStateSet()));
    return posed;
}

} // namespace osgGpuAnimation
