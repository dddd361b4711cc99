// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdCull.h>

#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>
#include <osgGpuAnimation/frame/crowd/SharedPoses.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseStage.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/MeshVisits.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

osg::BoundingBox boxAround(const glm::vec4& sphere)
{
    return {sphere.x - sphere.w, sphere.y - sphere.w, sphere.z - sphere.w,
            sphere.x + sphere.w, sphere.y + sphere.w, sphere.z + sphere.w};
}

/// One camera's view of a crowd during cull, in the crowd's space: the planes of the view, depths and draws. A
/// temporary object of the crowd's traversal.
class CrowdView
{
public:
    explicit CrowdView(osgUtil::CullVisitor& visitor) : _visitor(visitor) {}

    /// The planes of the view volume and of small feature culling; an instance is visible if it reaches n · p + d >= 0.
    std::vector<glm::vec4> planes() const
    {
        std::vector<glm::vec4> planes;
        osg::CullingSet& culling = _visitor.getCurrentCullingSet();
        const auto mask = culling.getCullingMask();
        if (mask & osg::CullingSet::VIEW_FRUSTUM_CULLING)
        {
            osg::Polytope& frustum = culling.getFrustum();
            osg::Polytope::ClippingMask bit = 1;
            for (const osg::Plane& plane : frustum.getPlaneList())
            {
                if (frustum.getCurrentMask() & bit) planes.emplace_back(plane[0], plane[1], plane[2], plane[3]);
                bit <<= 1;
            }
        }
        if (mask & osg::CullingSet::SMALL_FEATURE_CULLING)
        {
            // OSG's test for small features, p · v · pixels > radius, has the form of a plane.
            const osg::Vec4 plane = culling.getPixelSizeVector() * -culling.getSmallFeatureCullingPixelSize();
            planes.emplace_back(plane.x(), plane.y(), plane.z(), plane.w());
        }
        return planes;
    }

    /// Updates the camera's near and far planes. seen: at least one.
    void look(const SeenMembers& seen)
    {
        const osg::Matrix& toEye = *_visitor.getModelViewMatrix();
        const glm::vec4 depthOf(-toEye(0, 2), -toEye(1, 2), -toEye(2, 2), -toEye(3, 2));
        const float scale = glm::length(glm::vec3(depthOf));
        float nearest = 1e30f, max = -1e30f;
        glm::vec4 firstSphere(0.0f, 0.0f, 0.0f, -1.0f), lastSphere = firstSphere;
        const auto lookAt = [&](const SeenMembers::Span& span)
        {
            for (const CrowdMember* member = span.begin; member != span.end; ++member)
            {
                const glm::vec4& sphere = member->sphere;
                const float depth = glm::dot(depthOf, glm::vec4(glm::vec3(sphere), 1.0f));
                const float reach = sphere.w * scale;
                // Instances behind the eye do not affect the near plane.
                if (depth + reach < 0.0f) continue;
                if (depth - reach < nearest) nearest = depth - reach, firstSphere = sphere;
                if (depth + reach > max) max = depth + reach, lastSphere = sphere;
            }
        };
        const auto middleOf = [&](const SeenMembers::Span& span)
        { return glm::dot(depthOf, glm::vec4(span.centre, 1.0f)); };
        const auto isNearer = [&](const SeenMembers::Span& a, const SeenMembers::Span& b)
        { return middleOf(a) < middleOf(b); };
        // The other cells are mostly between the first and the last one.
        const auto [first, last] = std::minmax_element(seen.spans().begin(), seen.spans().end(), isNearer);
        lookAt(*first);
        lookAt(*last);
        for (const SeenMembers::Span& span : seen.spans())
        {
            const float half = glm::dot(glm::abs(glm::vec3(depthOf)), span.half) + span.radius * scale;
            if (middleOf(span) - half < nearest || middleOf(span) + half > max) lookAt(span);
        }
        if (firstSphere.w < 0.0f) return;
        _depth = 0.5f * (nearest + max);
        if (_visitor.getComputeNearFarMode() == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR) return;
        _visitor.updateCalculatedNearFar(toEye, boxAround(firstSphere));
        _visitor.updateCalculatedNearFar(toEye, boxAround(lastSphere));
    }

    /// Adds the mesh to the visitor's render bin at the mean depth of look() if its node mask allows it.
    void draw(SkinnedGeometry& mesh, const PaletteBinding& binding)
    {
        if (!_visitor.validNodeMask(mesh)) return;
        PoseStage::count(_visitor, mesh, binding);
        mesh.addTo(_visitor, _visitor.getModelViewMatrix(), _depth);
    }

private:
    osgUtil::CullVisitor& _visitor;
    float _depth = 0.0f; ///< distance from the eye
};

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
