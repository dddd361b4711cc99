// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The meshes of one character or of a crowd's instance in the last requested pose, as plain geometries that share
/// primitives, texture coordinates and state with their mesh. The CPU twin computes the pose once and keeps it until
/// another is requested, so that many rays in one frame cost one pose.
///
///     visitPosed(visitor, mesh, *posed.of(mesh, set, controller.instruction(), AffineMatrix()));
///
/// Thread-safe: concurrent calls wait for each other.
class PosedMeshes
{
public:
    /// set, instruction: the pose. rootToModel: multiplies the root joints. withNormals: computes them, too, if the
    /// mesh has them. A mesh whose vertex array was replaced or dirtied is posed again.
    osg::ref_ptr<osg::Geometry> of(const SkinnedGeometry& mesh, const std::shared_ptr<const AnimationSet>& set,
                                   const PoseInstruction& instruction, const AffineMatrix& rootToModel,
                                   bool withNormals = false);

private:
    struct Posed
    {
        osg::ref_ptr<const SkinnedGeometry> key;
        osg::ref_ptr<osg::Geometry> mesh;
        osg::ref_ptr<const osg::Array> bind; ///< the vertices in bind pose
        unsigned int modifiedCount = 0;      ///< of bind
        bool hasNormals = false;             ///< false: not requested yet
    };

    bool holds(const std::shared_ptr<const AnimationSet>& set, const PoseInstruction& instruction,
               const AffineMatrix& rootToModel) const;
    osg::ref_ptr<osg::Geometry> pose(const SkinnedGeometry& mesh, bool withNormals) const;

    std::mutex _mutex;
    std::shared_ptr<const AnimationSet> _set;
    PoseInstruction _instruction;
    std::vector<std::weak_ptr<const SetMask>> _masks; ///< of the instruction
    std::vector<std::uint64_t> _serials;              ///< of the instruction's poses
    AffineMatrix _rootToModel;
    std::vector<AffineMatrix> _palette;
    std::map<const SkinnedGeometry*, Posed> _meshes; ///< each value keeps its key alive
};

/// The model matrix of hits in a crowd's instance: hits refer to it, so it carries the instance to instanceOf().
class InstanceMatrix : public osg::RefMatrix
{
public:
    InstanceMatrix(const osg::Matrix& crowdToWorld, std::uint64_t instance)
        : osg::RefMatrix(crowdToWorld), _instance(instance)
    {
    }
    std::uint64_t getInstance() const { return _instance; }

protected:
    ~InstanceMatrix() override = default;

private:
    std::uint64_t _instance;
};

} // namespace osgGpuAnimation
