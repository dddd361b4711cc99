// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdCull.h>

#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>
#include <osgGpuAnimation/frame/crowd/SharedPoses.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseStage.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/MeshVisits.h>

namespace osgGpuAnimation
{

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
    for (const DrawState& draw : draws)
    {
        visitor.pushStateSet(draw.stateSet);
        lods.forEachMeshAt(draw.binding->getLevel(), crowd.meshes,
                           [&](const SkinnedGeometry& mesh, const SkinnedGeometry& part)
                           {
                               if (!crowd.outfits || crowd.outfits->listOf.at(&part) == draw.list)
                                   view.draw(const_cast<SkinnedGeometry&>(mesh), *draw.binding);
                           });
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
