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

/// A mesh as a character, or one instance of a crowd, shows it at one moment: what intersectors hit. Never drawn.
/// It lends the mesh's primitives, texture coordinates and state, so that what is asked of a hit's drawable is there.
class PosedMesh : public osg::Geometry
{
public:
    /// positions: one a vertex of the mesh. instance: where it is a crowd's.
    PosedMesh(const SkinnedGeometry& mesh, osg::Vec3Array* positions,
              std::optional<std::uint64_t> instance = std::nullopt);

    const SkinnedGeometry& mesh() const { return *_mesh; }
    std::optional<std::uint64_t> instance() const { return _instance; }

protected:
    ~PosedMesh() override = default;

private:
    osg::ref_ptr<const SkinnedGeometry> _mesh;
    std::optional<std::uint64_t> _instance;
};

/// The meshes of one character, or of one instance of a crowd, in the pose that was last asked for: computed by the CPU
/// twin when first asked, and kept until another pose is, so that many rays into one frame cost one pose.
///
///     posed.of(mesh, set, controller.instruction(), AffineMatrix())->accept(intersectionVisitor);
///
/// Any thread may ask; several at once wait for one another.
class PosedMeshes
{
public:
    /// set, instruction: the pose; rootToModel: what its roots are multiplied by. A mesh whose vertex array was
    /// replaced or dirtied since is posed anew.
    osg::ref_ptr<PosedMesh> of(const SkinnedGeometry& mesh, const std::shared_ptr<const AnimationSet>& set,
                               const PoseInstruction& instruction, const AffineMatrix& rootToModel);

private:
    struct Posed
    {
        osg::ref_ptr<PosedMesh> mesh;
        osg::ref_ptr<const osg::Array> bind; ///< the vertices it was made from
        unsigned int modifiedCount = 0;      ///< of theirs
    };

    bool holds(const std::shared_ptr<const AnimationSet>& set, const PoseInstruction& instruction,
               const AffineMatrix& rootToModel) const;
    void pose(const SkinnedGeometry& mesh, Posed& posed) const;

    std::mutex _mutex;
    std::shared_ptr<const AnimationSet> _set;
    PoseInstruction _instruction;
    AffineMatrix _rootToModel;
    std::vector<AffineMatrix> _palette;
    std::map<const SkinnedGeometry*, Posed> _meshes; ///< each holds its key
};

} // namespace osgGpuAnimation
