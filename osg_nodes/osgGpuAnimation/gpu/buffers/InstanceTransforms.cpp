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

InstanceTransformBuffers::Joined& InstanceTransformBuffers::find(const InstanceLists& lists)
{
    for (Joined& known : _joined)
        if (known.lists == lists) return known;
    Joined& joined = _joined[_oldest];
    _oldest = (_oldest + 1) % _joined.size();
    joined.lists = lists;
    joined.isUploaded = false;
    joined.transforms.clear();
    for (const auto& list : lists)
        joined.transforms.insert(joined.transforms.end(), list->begin(), list->end());
    return joined;
}

const InstanceTransformBuffers::Joined& InstanceTransformBuffers::joined(const InstanceLists& lists, bool uploads)
{
    Joined& joined = find(lists);
    if (uploads && !joined.isUploaded)
        joined.buffer->upload(joined.transforms.data(), joined.transforms.size() * sizeof(InstanceTransform));
    joined.isUploaded = joined.isUploaded || uploads;
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
        joined.isUploaded = false;
        joined.lists.clear();
    }
}

} // namespace osgGpuAnimation
