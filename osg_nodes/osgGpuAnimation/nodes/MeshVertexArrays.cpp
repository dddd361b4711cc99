// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/MeshVertexArrays.h>

#include <osg/ContextData>

namespace osgGpuAnimation
{

namespace
{

bool isOf(const osg::VertexArrayState& arrays, const osg::State& state)
{
    return arrays.getVertexArrayObject() != 0 && arrays._state == &state;
}

/// OSG takes an array at the address of a deleted one for the same.
void forgetArrays(osg::VertexArrayState& arrays)
{
    for (osg::VertexArrayState::ArrayDispatch* array : arrays._activeDispatchers)
    {
        array->array = nullptr;
        array->modifiedCount = ~0u;
    }
}

} // namespace

MeshVertexArrays::MeshVertexArrays(osg::State& state)
    : _state(state), _isContextsOwn(!isOf(*state.getCurrentVertexArrayState(), state))
{
    if (!_isContextsOwn) return;
    // A context that came to the number later has found the first one's.
    state.getCurrentVertexArrayState()->_vertexArrayObject = 0;
    _state.unbindVertexArrayObject();
    _state.setCurrentToGlobalVertexArrayState();
    forgetArrays(*_state.getCurrentVertexArrayState());
}

MeshVertexArrays::~MeshVertexArrays()
{
    if (_isContextsOwn)
    {
        _state.getCurrentVertexArrayState()->unbindVertexBufferObject();
        _state.getCurrentVertexArrayState()->unbindElementBufferObject();
    }
    // Whatever OSG compiles between frames would take the element buffer away from a vertex array left bound.
    _state.unbindVertexArrayObject();
}

bool MeshVertexArrays::isNumberShared(const osg::State& state)
{
    const osg::ContextData* data = osg::getContextData(state.getContextID());
    return data && data->getNumContexts() > 1;
}

void MeshVertexArrays::removeObject(osg::VertexArrayState& arrays)
{
    arrays.deleteVertexArrayObject();
    arrays._vertexArrayObject = 0; // which OSG leaves as it was
}

} // namespace osgGpuAnimation
