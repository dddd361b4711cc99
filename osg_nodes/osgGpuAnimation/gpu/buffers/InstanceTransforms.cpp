// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>

#include <osg/ContextData>

namespace osgGpuAnimation
{

InstanceTransformBuffers::InstanceTransformBuffers(unsigned int contextId)
    : osg::GraphicsObjectManager("InstanceTransformBuffers", contextId)
{
    for (List& list : _lists)
        list.buffer = std::make_unique<BufferTexture>(*osg::GLExtensions::Get(contextId, true), GL_RGBA32F_ARB);
}

InstanceTransformBuffers& InstanceTransformBuffers::of(osg::State& state)
{
    return *osg::get<InstanceTransformBuffers>(state.getContextID());
}

const BufferTexture& InstanceTransformBuffers::buffer(std::uint64_t serial,
                                                      const std::vector<InstanceTransform>& transforms)
{
    for (const List& list : _lists)
        if (list.serial == serial) return *list.buffer;
    List& list = _lists[_oldest];
    _oldest = (_oldest + 1) % _lists.size();
    list.serial = serial;
    list.buffer->upload(transforms.data(), transforms.size() * sizeof(InstanceTransform));
    return *list.buffer;
}

void InstanceTransformBuffers::deleteAllGLObjects()
{
    for (List& list : _lists)
        list.buffer->release();
    discardAllGLObjects();
}

void InstanceTransformBuffers::discardAllGLObjects()
{
    for (List& list : _lists)
    {
        list.buffer->discard();
        list.serial = 0;
    }
}

} // namespace osgGpuAnimation
