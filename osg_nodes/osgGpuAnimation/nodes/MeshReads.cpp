// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/MeshReads.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/SkinOnceRun.h>

#include <array>
#include <string>

namespace osgGpuAnimation
{

namespace
{

osg::StateSet* makeSkinnedState(int texels)
{
    osg::StateSet* state = new osg::StateSet;
    state->setDefine("POSE_SKINNED", std::to_string(texels));
    return state;
}

} // namespace

osg::StateSet* MeshReads::skinnedState(int texels)
{
    static const std::array<osg::ref_ptr<osg::StateSet>, 2> states{makeSkinnedState(1), makeSkinnedState(2)};
    return states[static_cast<std::size_t>(texels - 1)];
}

void MeshReads::begin(unsigned int contextId)
{
    _reads.clear();
    _plan = SkinningPlan::forContext(contextId);
    _once = _plan->once();
}

osg::StateSet* MeshReads::add(const SkinnedGeometry& mesh, const PaletteBinding& binding)
{
    const bool isOnce = _once->count(mesh.number()) != 0;
    _reads.push_back({&mesh, &binding, isOnce});
    return isOnce ? skinnedState(mesh.skinnedTexels()) : nullptr;
}

void MeshReads::skin(osg::RenderInfo& renderInfo, std::uint64_t frame)
{
    osg::State& state = *renderInfo.getState();
    const PosePipeline* pipeline = PosePipeline::of(state);
    _plan->begin(state, frame);
    SkinOnceRun run(renderInfo);
    for (const Read& read : _reads)
    {
        if (!pipeline) break;
        const PaletteBinding& binding = *read.binding;
        const AnimationSet& set = *binding.animationSet();
        _plan->count(*read.mesh, set, binding.slot(), pipeline->instanceCount(set, binding.slot()),
                     binding.drawnCount());
        if (read.isOnce) run.skin(*read.mesh, set, binding.slot());
    }
    _reads.clear();
}

} // namespace osgGpuAnimation
