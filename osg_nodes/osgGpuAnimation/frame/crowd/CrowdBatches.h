// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/crowd/OutfitLists.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseFrame.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osgUtil/CullVisitor>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// A cache of posed meshes for the crowd instances that were requested last: rays hit few instances. Thread-safe.
class PosedInstances
{
public:
    /// The capacity; one more instance clears the cache. Enough for the hits of one ray, small beside the meshes.
    static constexpr std::size_t maxKept = 64;

    std::shared_ptr<PosedMeshes> of(CrowdInstances::Handle instance);

private:
    std::mutex _mutex;
    std::map<CrowdInstances::Handle, std::shared_ptr<PosedMeshes>> _kept;
};

/// One camera's view of a crowd during cull, in the crowd's space: the planes of the view, depths and draws. A
/// temporary object of the crowd's traversal.
class CrowdView
{
public:
    explicit CrowdView(osgUtil::CullVisitor& visitor) : _visitor(visitor) {}

    /// The planes of the view volume and of small feature culling; an instance is visible if it reaches n · p + d >= 0.
    std::vector<glm::vec4> planes() const;
    /// Updates the camera's near and far planes. seen: at least one.
    void look(const SeenMembers& seen);
    /// Adds the mesh to the visitor's render bin at the mean depth of look() if its node mask allows it.
    void draw(SkinnedGeometry& mesh, const PaletteBinding& binding);

private:
    osgUtil::CullVisitor& _visitor;
    float _depth = 0.0f; ///< distance from the eye
};

/// The levels of detail of a crowd's instances for one camera.
class CrowdLod
{
public:
    CrowdLod(const CrowdInstances& instances, const LodScale& scale) : _instances(instances), _scale(scale) {}

    bool isOn() const { return _scale.isOn(); }
    /// Sorts the indices by level, the finest first; stable within a level.
    void sort(std::vector<std::uint32_t>& indices, std::vector<OutfitLists::Run>& outRuns) const;

private:
    int levelOf(std::uint32_t index) const;

    const CrowdInstances& _instances;
    const LodScale& _scale;
};

/// Submits a batch with the list of its instances and appends a draw for each run.
void submitPlaced(PoseFrame& frame, const CrowdInstances& instances, std::unique_ptr<PoseBatch> batch,
                  const std::shared_ptr<const PlacedInstances>& list, const std::vector<OutfitLists::Run>& runs,
                  std::vector<DrawState>& draws);

/// Submits the visible instances of a crowd to the frame and returns one state per draw of the crowd's meshes.
/// Instances with one clip form one batch, and instances that mix clips form others if there are enough
/// (PoseBatch::BlendCost); instances with and without constraints never share one. Each level of detail in use has its
/// own draw. lists: of a crowd with outfits; null: none. seen: indices of the visible instances. Cameras may cull
/// concurrently.
std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const CrowdLod& lod,
                                  const DrawnLists* lists, const std::vector<std::uint32_t>& seen);

} // namespace osgGpuAnimation
