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
    using Meshes = std::vector<std::pair<SkinnedGeometry*, OutfitLists::Mesh>>;

    LevelMeshes(const CulledCrowd& crowd, const LodRange& lods) : _crowd(crowd), _lods(lods) {}

    const Meshes& at(int level)
    {
        if (_level == level) return _meshes;
        _level = level;
        _meshes.clear();
        _lods.forEachMeshAt(level, _crowd.meshes,
                            [&](const SkinnedGeometry& mesh)
                            { _meshes.emplace_back(const_cast<SkinnedGeometry*>(&mesh), drawn(mesh)); });
        return _meshes;
    }

    /// By list: whether it is drawn. The meshes below other children have that of all instances.
    std::vector<bool> listsAt(int level)
    {
        std::vector<bool> lists(_crowd.outfits->lists.size(), false);
        for (const auto& [mesh, drawn] : at(level))
            lists[drawn.list] = true;
        for (unsigned int child = 0; child < _crowd.node.getNumChildren(); ++child)
            if (!dynamic_cast<const SkinnedGeometry*>(_crowd.node.getChild(child))) lists[OutfitLists::all] = true;
        return lists;
    }

private:
    OutfitLists::Mesh drawn(const SkinnedGeometry& mesh) const
    {
        if (!_crowd.outfits) return {};
        const auto known = _crowd.outfits->meshes.find(&mesh);
        return known == _crowd.outfits->meshes.end() ? OutfitLists::Mesh() : known->second;
    }

    const CulledCrowd& _crowd;
    const LodRange& _lods;
    Meshes _meshes;
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
    LevelMeshes meshes(crowd, lods);
    if (seen.size() > 0 && set.paletteSize() > 0)
    {
        view.look(seen);
        if (crowd.pixelError > 0.0f) lods = LodRange(crowd.meshes, set, crowd.levels);
        const LodScale scale(visitor, PoseStage::lodView(visitor), crowd.pixelError, lods);
        std::optional<DrawnLists> lists;
        if (crowd.outfits) lists.emplace(DrawnLists{*crowd.outfits, [&](int level) { return meshes.listsAt(level); }});
        draws = submitSeen(PoseStage::frame(visitor), crowd.instances, scale, crowd.sharedPoses,
                           lists ? &*lists : nullptr, seen);
    }
    for (const DrawState& draw : draws)
    {
        visitor.pushStateSet(draw.stateSet);
        for (const auto& [mesh, drawn] : meshes.at(draw.binding->getLevel()))
        {
            if (drawn.list != draw.list) continue;
            if (drawn.parts) visitor.pushStateSet(drawn.parts);
            view.draw(*mesh, *draw.binding);
            if (drawn.parts) visitor.popStateSet();
        }
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
