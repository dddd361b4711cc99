// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// A mesh in one pose of a character or of a crowd's instance, for intersectors; never drawn. It shares the mesh's
/// primitives, texture coordinates and state, so that users of a hit find them at its drawable.
class PosedMesh : public osg::Geometry
{
public:
    /// positions: one per vertex of the mesh. instance: the crowd's; empty for a character.
    PosedMesh(const SkinnedGeometry& mesh, osg::Vec3Array* positions,
              std::optional<std::uint64_t> instance = std::nullopt);

    const SkinnedGeometry& getMesh() const { return *_mesh; }
    std::optional<std::uint64_t> getInstance() const { return _instance; }

protected:
    ~PosedMesh() override = default;

private:
    osg::ref_ptr<const SkinnedGeometry> _mesh;
    std::optional<std::uint64_t> _instance;
};

/// The meshes of one character or of a crowd's instance in the last requested pose. The CPU twin computes the pose once
/// and keeps it until another is requested, so that many rays in one frame cost one pose.
///
///     posed.of(mesh, set, controller.instruction(), AffineMatrix())->accept(intersectionVisitor);
///
/// Thread-safe: concurrent calls wait for each other.
class PosedMeshes
{
public:
    /// set, instruction: the pose. rootToModel: multiplies the root joints. A mesh whose vertex array was replaced or
    /// dirtied is posed again.
    osg::ref_ptr<PosedMesh> of(const SkinnedGeometry& mesh, const std::shared_ptr<const AnimationSet>& set,
                               const PoseInstruction& instruction, const AffineMatrix& rootToModel);

private:
    struct Posed
    {
        osg::ref_ptr<PosedMesh> mesh;
        osg::ref_ptr<const osg::Array> bind; ///< the vertices in bind pose
        unsigned int modifiedCount = 0;      ///< of bind
    };

    bool holds(const std::shared_ptr<const AnimationSet>& set, const PoseInstruction& instruction,
               const AffineMatrix& rootToModel) const;
    void pose(const SkinnedGeometry& mesh, Posed& posed) const;

    std::mutex _mutex;
    std::shared_ptr<const AnimationSet> _set;
    PoseInstruction _instruction;
    std::vector<std::weak_ptr<const SetMask>> _masks; ///< of the instruction
    AffineMatrix _rootToModel;
    std::vector<AffineMatrix> _palette;
    std::map<const SkinnedGeometry*, Posed> _meshes; ///< each value keeps its key alive
};

} // namespace osgGpuAnimation
