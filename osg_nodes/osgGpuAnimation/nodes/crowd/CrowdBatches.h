// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/frame/PaletteBinding.h>
#include <osgGpuAnimation/nodes/frame/PoseFrame.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>
#include <osgGpuAnimation/nodes/picking/PosedMesh.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgUtil/CullVisitor>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The posed meshes of those instances of a crowd that were asked for of late: rays hit few of many. Any thread may
/// ask.
class PosedInstances
{
public:
    /// Instances kept; with one more all go. Enough for what lies along a ray, and small beside the crowd's meshes.
    static constexpr std::size_t maxKept = 64;

    std::shared_ptr<PosedMeshes> of(CrowdInstances::Handle instance);

private:
    std::mutex _mutex;
    std::map<CrowdInstances::Handle, std::shared_ptr<PosedMeshes>> _kept;
};

/// A crowd as one camera sees it while it is culled: what is in view, how far away, and how meshes are handed on to be
/// drawn. Lives as long as the crowd's own traversal, in its space.
class CrowdView
{
public:
    explicit CrowdView(osgUtil::CullVisitor& visitor) : _visitor(visitor) {}

    /// What an instance must reach the inner side of: n · p + d >= 0. The view's, and one for what is too small.
    std::vector<glm::vec4> planes() const;
    /// Tells the camera's near and far planes of them. indices: those that are seen, at least one.
    void look(const CrowdInstances& instances, const std::vector<std::uint32_t>& indices);
    /// Adds the mesh to the visitor's render bin, at the depth of those looked at, where the visitor's mask allows it.
    void draw(SkinnedGeometry& mesh, const PaletteBinding& binding);

private:
    osgUtil::CullVisitor& _visitor;
    float _depth = 0.0f; ///< before the eye
};

/// Levels of detail of a crowd's instances as one camera sees them.
class CrowdLod
{
public:
    /// Instances of one level, one after another.
    struct Run
    {
        int level;
        std::size_t count;
    };

    CrowdLod(const CrowdInstances& instances, const LodScale& scale) : _instances(instances), _scale(scale) {}

    bool isOn() const { return _scale.isOn(); }
    /// Puts those of one level together, the finest first; otherwise they stay in their order.
    void sort(std::vector<std::uint32_t>& indices, std::vector<Run>& outRuns) const;

private:
    int levelOf(std::uint32_t index) const;

    const CrowdInstances& _instances;
    const LodScale& _scale;
};

/// Has the frame evaluate the poses of the instances that a camera sees of a crowd, and returns the states to draw the
/// crowd's meshes with, one a draw. Instances that show one clip form one batch, those that mix clips others, where
/// there are many (PoseBatch::Load). Each level of detail in use has a draw of its own. seen: indices. Several cameras
/// may cull at once.
std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const CrowdLod& detail,
                                  const std::vector<std::uint32_t>& seen);

} // namespace osgGpuAnimation
