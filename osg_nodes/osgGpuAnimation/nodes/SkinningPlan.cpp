// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SkinningPlan.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/gpu/SkinnedVertices.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Notify>

#include <algorithm>
#include <map>

namespace osgGpuAnimation
{

osg::ref_ptr<SkinningPlan> SkinningPlan::forContext(unsigned int contextId)
{
    static std::mutex mutex;
    static std::unordered_map<unsigned int, osg::ref_ptr<SkinningPlan>> plans;
    const std::lock_guard<std::mutex> lock(mutex);
    osg::ref_ptr<SkinningPlan>& plan = plans[contextId];
    if (!plan) plan = new SkinningPlan;
    return plan;
}

// What lies in a buffer by instance is read as slowly, in llvmpipe, as four influences are mixed: morphs make the
// difference.
int SkinningPlan::breakEven(std::size_t morphTargets)
{
    if (morphTargets < 2) return 0;
    return morphTargets < 4 ? 4 : morphTargets < 8 ? 3 : 2;
}

std::shared_ptr<const SkinningPlan::Meshes> SkinningPlan::once() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _once;
}

void SkinningPlan::begin(osg::State& state, std::uint64_t frame)
{
    if (frame == _frame) return;
    decide(state);
    _frame = frame;
}

void SkinningPlan::count(const SkinnedGeometry& mesh, const AnimationSet& set, std::size_t slot, std::size_t posed,
                         std::size_t drawn)
{
    Tally& tally = tallyOf(mesh);
    tally.drawn += drawn;
    const std::pair<const AnimationSet*, std::size_t> batch(&set, slot);
    if (std::find(tally.batches.begin(), tally.batches.end(), batch) != tally.batches.end()) return;
    tally.batches.push_back(batch);
    tally.posed += posed;
}

SkinningPlan::Tally& SkinningPlan::tallyOf(const SkinnedGeometry& mesh)
{
    const auto [known, isNew] = _tallyOfMesh.try_emplace(mesh.number(), _tallies.size());
    if (!isNew) return _tallies[known->second];
    const std::size_t texels = mesh.skinnedTexelCount();
    _tallies.push_back({mesh.number(),
                        mesh.skinning(),
                        breakEven(mesh.morphTargets().size()),
                        mesh.onceVariant(),
                        texels,
                        mesh.getName(),
                        0,
                        0,
                        {}});
    return _tallies.back();
}

void SkinningPlan::decide(osg::State& state)
{
    std::shared_ptr<Meshes> once = std::make_shared<Meshes>();
    std::size_t bytes = 0;
    std::map<SkinOncePass::Variant, bool> tried;
    const auto works = [&](const SkinOncePass::Variant& variant)
    {
        const auto [known, isNew] = tried.try_emplace(variant);
        if (isNew) known->second = SkinOncePass::shared()->works(state, variant);
        return known->second;
    };
    for (const Tally& tally : _tallies)
    {
        const bool isCheaper =
            tally.breakEven > 0 && tally.drawn >= static_cast<std::size_t>(tally.breakEven) * tally.posed;
        if (tally.skinning == Skinning::Auto && !isCheaper) continue;
        if (!fits(state, tally, bytes) || !works(tally.variant)) continue;
        bytes += tally.posed * tally.texels * BufferTexture::texelBytes;
        once->insert(tally.mesh);
    }
    // Whoever is not there any more has another number, or is skinned by every draw again.
    for (const std::uint64_t mesh : *_once)
        if (once->count(mesh) == 0) SkinnedVertices::of(state).release(mesh);
    _tallies.clear();
    _tallyOfMesh.clear();
    const std::lock_guard<std::mutex> lock(_mutex);
    _once = std::move(once);
}

bool SkinningPlan::fits(osg::State& state, const Tally& tally, std::size_t bytesTaken)
{
    const PosePipeline* pipeline = PosePipeline::of(state);
    if (!pipeline || tally.texels == 0) return false;
    const std::size_t maxBytes = SkinnedVertices::of(state).maxBytes();
    const std::size_t bytes = tally.posed * tally.texels * BufferTexture::texelBytes;
    if (tally.texels <= pipeline->maxTexels() && bytes <= maxBytes - std::min(bytesTaken, maxBytes)) return true;
    if (tally.skinning == Skinning::Once && _reported.insert(tally.mesh).second)
        OSG_WARN << "osgGpuAnimation: mesh \"" << tally.name << "\" is skinned by every draw: once, its " << tally.posed
                 << " instances would take " << tally.texels << " texels each, " << bytes << " bytes together beside "
                 << bytesTaken << " of other meshes; there may be " << pipeline->maxTexels() << " texels and "
                 << maxBytes << " bytes" << std::endl;
    return false;
}

} // namespace osgGpuAnimation
