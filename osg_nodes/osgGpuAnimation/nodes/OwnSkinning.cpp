// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/OwnSkinning.h>

#include <osgGpuAnimation/nodes/MeshReads.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

namespace osgGpuAnimation
{

namespace
{

osg::StateSet* makeUnskinnedState()
{
    osg::StateSet* state = new osg::StateSet;
    state->setDefine("POSE_SKINNED", osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    return state;
}

} // namespace

OwnSkinning::OwnSkinning(osg::State& state, const SkinnedGeometry& mesh) : _state(state), _mesh(mesh)
{
    static const osg::ref_ptr<osg::StateSet> unskinned = makeUnskinnedState();
    _state.pushStateSet(unskinned);
    apply(_mesh.getStateSet());
}

// A leaf's own state, the last on the way down, is applied without being on OSG's stack.
OwnSkinning::~OwnSkinning()
{
    _state.popStateSet();
    apply(_mesh.getStateSet() ? _mesh.getStateSet() : MeshReads::skinnedState(_mesh.skinnedTexels()));
}

void OwnSkinning::apply(const osg::StateSet* stateSet)
{
    _state.apply(stateSet);
    if (_state.getUseModelViewAndProjectionUniforms()) _state.applyModelViewAndProjectionUniformsIfRequired();
}

} // namespace osgGpuAnimation
