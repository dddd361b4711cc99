// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>

#include <osg/ContextData>

namespace osgGpuAnimation
{

PlacementBuffers::PlacementBuffers(unsigned int contextId) : osg::GraphicsObjectManager("PlacementBuffers", contextId)
{
    for (List& list : _lists)
        list.buffer = std::make_unique<BufferTexture>(*osg::GLExtensions::Get(contextId, true), GL_RGBA32F_ARB);
}

PlacementBuffers& PlacementBuffers::of(osg::State& state)
{
    return *osg::get<PlacementBuffers>(state.getContextID());
}

const BufferTexture& PlacementBuffers::buffer(std::uint64_t serial, const std::vector<Placement>& placements)
{
    for (const List& list : _lists)
        if (list.serial == serial) return *list.buffer;
    List& list = _lists[_oldest];
    _oldest = (_oldest + 1) % _lists.size();
    list.serial = serial;
    list.buffer->upload(placements.data(), placements.size() * sizeof(Placement));
    return *list.buffer;
}

void PlacementBuffers::deleteAllGLObjects()
{
    for (List& list : _lists)
        list.buffer->release();
    discardAllGLObjects();
}

void PlacementBuffers::discardAllGLObjects()
{
    for (List& list : _lists)
    {
        list.buffer->discard();
        list.serial = 0;
    }
}

} // namespace osgGpuAnimation
