// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>

#include <osgGpuAnimation/frame/stage/PoseStage.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

osg::BoundingBox boxAround(const glm::vec4& sphere)
{
    return {sphere.x - sphere.w, sphere.y - sphere.w, sphere.z - sphere.w,
            sphere.x + sphere.w, sphere.y + sphere.w, sphere.z + sphere.w};
}

using Indices = std::vector<std::uint32_t>;

/// Instances by blend cost, first those without constraints, then those with.
using IndicesByCost = std::array<Indices, 2 * PoseBatch::blendCostCount>;

/// Groups too small for a batch join the next higher cost. first: the lowest cost.
void joinSmallGroups(IndicesByCost& indicesByCost, std::size_t first)
{
    std::size_t higherCost = first + PoseBatch::blendCostCount - 1;
    for (std::size_t cost = higherCost; cost-- > first;)
        if (!indicesByCost[cost].empty() && indicesByCost[cost].size() < PoseBatch::minBatchSize &&
            !indicesByCost[higherCost].empty())
        {
            indicesByCost[higherCost].insert(indicesByCost[higherCost].end(), indicesByCost[cost].begin(),
                                             indicesByCost[cost].end());
            indicesByCost[cost].clear();
        }
        else if (!indicesByCost[cost].empty())
            higherCost = cost;
}

void sortByBlendCost(const CrowdInstances& instances, const Indices& seen, IndicesByCost& indicesByCost)
{
    for (Indices& indices : indicesByCost)
        indices.clear();
    for (const std::uint32_t index : seen)
    {
        const std::size_t first = instances.isConstrained(index) ? PoseBatch::blendCostCount : 0;
        indicesByCost[first + static_cast<std::size_t>(instances.blendCost(index))].push_back(index);
    }
    joinSmallGroups(indicesByCost, 0);
    joinSmallGroups(indicesByCost, PoseBatch::blendCostCount);
}

/// Submits instances with outfits, as many at once as one palette of the context holds, and appends their draws. runs:
/// the levels of the indices.
void submitListed(PoseFrame& frame, const CrowdInstances& instances, const DrawnLists& lists, const Indices& indices,
                  const std::vector<OutfitLists::Run>& runs, std::vector<DrawState>& draws)
{
    PosePipeline::Options options;
    options.maxTexels = frame.getMaxTexels();
    const std::size_t max = PosePipeline::chunkCapacity(*instances.set(), options);
    for (std::size_t first = 0; first < indices.size(); first += max)
    {
        const std::size_t end = std::min(first + max, indices.size());
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, indices.data() + first, end - first);
        const std::shared_ptr<PlacedInstances> list = std::make_shared<PlacedInstances>();
        list->crowd = instances.identity();
        list->poseCount = batch->size();
        list->drawn.reserve(end - first);
        for (std::size_t i = first; i < end; ++i)
            list->drawn.push_back({static_cast<std::uint32_t>(i - first), indices[i]});
        std::vector<OutfitLists::Run> listed;
        for (const OutfitLists::Run& run : runs)
        {
            const std::size_t begin = std::max(run.first, first), stop = std::min(run.first + run.count, end);
            if (begin < stop) listed.push_back({run.level, begin - first, stop - begin});
        }
        lists.arrange(instances, list->drawn, listed);
        submitPlaced(frame, instances, std::move(batch), list, listed, draws);
    }
}

} // namespace

std::shared_ptr<PosedMeshes> PosedInstances::of(CrowdInstances::Handle instance)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto kept = _kept.find(instance);
    if (kept != _kept.end()) return kept->second;
    if (_kept.size() >= maxKept) _kept.clear();
    return _kept[instance] = std::make_shared<PosedMeshes>();
}

std::vector<glm::vec4> CrowdView::planes() const
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

void CrowdView::look(const SeenMembers& seen)
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

void CrowdView::draw(SkinnedGeometry& mesh, const PaletteBinding& binding)
{
    if (!_visitor.validNodeMask(mesh)) return;
    PoseStage::count(_visitor, mesh, binding);
    mesh.addTo(_visitor, _visitor.getModelViewMatrix(), _depth);
}

int CrowdLod::levelOf(std::uint32_t index) const
{
    const glm::vec4& sphere = _instances.sphere(index);
    return _scale.level(glm::vec3(sphere), sphere.w, _instances.rootMatrix(index));
}

void CrowdLod::sort(std::vector<std::uint32_t>& indices, std::vector<OutfitLists::Run>& outRuns) const
{
    static thread_local std::map<int, Indices> levels; // keeps its storage between culls
    for (auto& [level, ofLevel] : levels)
        ofLevel.clear();
    int lastLevel = 0;
    Indices* last = nullptr;
    for (const std::uint32_t index : indices)
    {
        const int level = levelOf(index);
        if (!last || level != lastLevel) last = &levels[level];
        lastLevel = level;
        last->push_back(index);
    }
    indices.clear();
    outRuns.clear();
    for (const auto& [level, ofLevel] : levels)
    {
        if (ofLevel.empty()) continue;
        outRuns.push_back({level, indices.size(), ofLevel.size()});
        indices.insert(indices.end(), ofLevel.begin(), ofLevel.end());
    }
}

void submitPlaced(PoseFrame& frame, const CrowdInstances& instances, std::unique_ptr<PoseBatch> batch,
                  const std::shared_ptr<const PlacedInstances>& list, const std::vector<OutfitLists::Run>& runs,
                  std::vector<DrawState>& draws)
{
    const std::size_t slot = frame.submitShared(std::move(batch), &instances, list);
    for (const OutfitLists::Run& run : runs)
    {
        draws.push_back(frame.placedState(*instances.set(), slot, list, run.first, run.count, run.level));
        draws.back().list = run.list;
    }
}

std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const CrowdLod& lod,
                                  const DrawnLists* lists, const std::vector<std::uint32_t>& seen)
{
    static thread_local IndicesByCost indicesByCost;
    sortByBlendCost(instances, seen, indicesByCost);
    std::vector<DrawState> draws;
    std::vector<OutfitLists::Run> runs;
    for (Indices& indices : indicesByCost)
    {
        if (indices.empty()) continue;
        if (lod.isOn()) lod.sort(indices, runs);
        if (lists)
        {
            if (!lod.isOn()) runs = {{PaletteBinding::allTriangles, 0, indices.size()}};
            submitListed(frame, instances, *lists, indices, runs, draws);
            continue;
        }
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, indices.data(), indices.size());
        const SubmittedBatch submitted = frame.submit(std::move(batch), &instances, indices);
        if (!lod.isOn()) draws.push_back(submitted.all);
        for (const OutfitLists::Run& run : runs)
            draws.push_back(frame.partState(*instances.set(), submitted.slot, run.first, run.count, run.level));
    }
    return draws;
}

} // namespace osgGpuAnimation
