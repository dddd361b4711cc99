// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>

#include <osg/ContextData>

namespace osgGpuAnimation
{

InstanceTransformBuffers::InstanceTransformBuffers(unsigned int contextId)
    : osg::GraphicsObjectManager("InstanceTransformBuffers", contextId)
{
    for (Joined& joined : _joined)
        joined.buffer = std::make_unique<BufferTexture>(*osg::GLExtensions::Get(contextId, true), GL_RGBA32F_ARB);
}

InstanceTransformBuffers& InstanceTransformBuffers::of(osg::State& state)
{
    return *osg::get<InstanceTransformBuffers>(state.getContextID());
}

const InstanceTransformBuffers::Joined& InstanceTransformBuffers::joined(const InstanceLists& lists)
{
    for (const Joined& known : _joined)
        if (known.lists == lists) return known;
    Joined& joined = _joined[_oldest];
    _oldest = (_oldest + 1) % _joined.size();
    joined.lists = lists;
    joined.transforms.clear();
    for (const auto& list : lists)
        joined.transforms.insert(joined.transforms.end(), list->begin(), list->end());
    joined.buffer->upload(joined.transforms.data(), joined.transforms.size() * sizeof(InstanceTransform));
    return joined;
}

void InstanceTransformBuffers::deleteAllGLObjects()
{
    for (Joined& joined : _joined)
        joined.buffer->release();
    discardAllGLObjects();
}

void InstanceTransformBuffers::discardAllGLObjects()
{
    for (Joined& joined : _joined)
    {
        joined.buffer->discard();
        joined.lists.clear();
    }
}

} // namespace osgGpuAnimation
