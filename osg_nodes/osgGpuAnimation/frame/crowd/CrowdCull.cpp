// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdCull.h>

#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>
#include <osgGpuAnimation/frame/crowd/SharedPoses.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseStage.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/MeshVisits.h>

#include <optional>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// The meshes to draw at a level, each with its list of instances.
class LevelMeshes
{
public:
    using Meshes = std::vector<std::pair<SkinnedGeometry*, std::size_t>>;

    LevelMeshes(const CulledCrowd& crowd, const LodRange& lods) : _crowd(crowd), _lods(lods), _meshes(storage()) {}

    const Meshes& at(int level)
    {
        if (_level == level) return _meshes;
        _level = level;
        _meshes.clear();
        _lods.forEachMeshAt(level, _crowd.meshes,
                            [&](const SkinnedGeometry& mesh, const SkinnedGeometry& part)
                            {
                                const std::size_t list =
                                    _crowd.outfits ? _crowd.outfits->listOf.at(&part) : OutfitLists::all;
                                _meshes.emplace_back(const_cast<SkinnedGeometry*>(&mesh), list);
                            });
        return _meshes;
    }

private:
    static Meshes& storage()
    {
        static thread_local Meshes meshes; // keeps its storage from cull to cull
        return meshes;
    }

    const CulledCrowd& _crowd;
    const LodRange& _lods;
    Meshes& _meshes;
    std::optional<int> _level; ///< of the meshes
};

} // namespace

void cullCrowd(const CulledCrowd& crowd, osgUtil::CullVisitor& visitor)
{
    const DepthPass pass(visitor);
    const ViewLightsScope lights(visitor);
    CrowdView view(visitor);
    static thread_local SeenMembers seen; // keeps its storage from cull to cull
    const AnimationSet& set = *crowd.instances.set();
    crowd.instances.findSeen(crowd.node.isCullingActive() ? view.planes() : std::vector<glm::vec4>(), seen);
    std::vector<DrawState> draws;
    LodRange lods;
    if (seen.size() > 0 && set.paletteSize() > 0)
    {
        view.look(seen);
        static const CharacterLevels::Lists all;
        const CharacterLevels::Lists& lists = crowd.outfits ? crowd.outfits->ofMeshes : all;
        if (crowd.pixelError > 0.0f) lods = LodRange(crowd.meshes, set, crowd.levels, lists);
        const LodScale scale(visitor, PoseStage::lodView(visitor), crowd.pixelError, lods);
        draws = submitSeen(PoseStage::frame(visitor), crowd.instances, scale, crowd.sharedPoses, crowd.outfits, seen);
    }
    LevelMeshes meshes(crowd, lods);
    for (const DrawState& draw : draws)
    {
        visitor.pushStateSet(draw.stateSet);
        for (const auto& [mesh, list] : meshes.at(draw.binding->getLevel()))
            if (list == draw.list) view.draw(*mesh, *draw.binding);
        visitor.popStateSet();
    }
    const UnculledScope unculled(visitor);
    const MeshDrawScope scope(crowd.source,
                              [&](SkinnedGeometry& mesh)
                              {
                                  for (const DrawState& draw : draws)
                                  {
                                      if (draw.list != OutfitLists::all) continue;
                                      visitor.pushStateSet(draw.stateSet);
                                      view.draw(mesh, *draw.binding);
                                      visitor.popStateSet();
                                  }
                              });
    for (unsigned int child = 0; child < crowd.node.getNumChildren(); ++child)
        if (!dynamic_cast<const SkinnedGeometry*>(crowd.node.getChild(child)))
            crowd.node.getChild(child)->accept(visitor);
}

} // namespace osgGpuAnimation
