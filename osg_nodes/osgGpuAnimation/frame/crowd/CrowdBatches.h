// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/crowd/OutfitLists.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseFrame.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>

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

/// Submits a batch with the list of its instances and appends a draw for each run.
void submitPlaced(PoseFrame& frame, const CrowdInstances& instances, std::unique_ptr<PoseBatch> batch,
                  const std::shared_ptr<const PlacedInstances>& list, const std::vector<OutfitLists::Run>& runs,
                  std::vector<DrawState>& draws);

/// Submits the visible instances of a crowd to the frame and returns one state per draw of the crowd's meshes.
/// Instances with one clip form one batch, and instances that mix clips form others if there are enough
/// (PoseBatch::BlendCost); instances with and without constraints never share one. Each level of detail in use has its
/// own draw. scale: of the camera. lists: of a crowd with outfits; null: none. seen: indices of the visible instances.
/// Cameras may cull concurrently.
std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  const DrawnLists* lists, const std::vector<std::uint32_t>& seen);

} // namespace osgGpuAnimation
