// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>

#include <osg/ContextData>

#include <algorithm>

namespace osgGpuAnimation
{

PlacedInstanceBuffers::PlacedInstanceBuffers(unsigned int contextId)
    : osg::GraphicsObjectManager("PlacedInstanceBuffers", contextId), _gl(osg::GLExtensions::Get(contextId, true))
{
}

PlacedInstanceBuffers& PlacedInstanceBuffers::of(osg::State& state)
{
    return *osg::get<PlacedInstanceBuffers>(state.getContextID());
}

template <typename Element>
void PlacedInstanceBuffers::upload(const typename SharedBlocks<Element>::Snapshot& content, Uploaded<Element>& uploaded)
{
    if (uploaded.content == content) return;
    typename SharedBlocks<Element>::Blocks blocks;
    if (uploaded.content) blocks = *uploaded.content;
    std::vector<Element> memory;
    _bytesUploaded += uploadChangedUnits(
        *uploaded.buffer, sizeof(typename SharedBlocks<Element>::Block), content->size(), blocks,
        memory, [&](std::size_t block) -> const auto& { return (*content)[block]; },
        [&](std::size_t block) -> const auto& { return *(*content)[block]; });
    uploaded.content = content;
}

const BufferTexture& PlacedInstanceBuffers::listBuffer(const std::shared_ptr<const PlacedInstances>& placed)
{
    auto list =
        std::find_if(_lists.begin(), _lists.end(), [&](const List& known) { return known.list.lock() == placed; });
    if (list != _lists.end()) return *list->buffer;
    list = std::find_if(_lists.begin(), _lists.end(), [](const List& known) { return known.list.expired(); });
    if (list == _lists.end()) list = _lists.insert(list, {{}, std::make_unique<BufferTexture>(*_gl, GL_RG32UI)});
    list->list = placed;
    const std::size_t bytes = placed->drawn.size() * sizeof(PlacedInstances::Drawn);
    list->buffer->upload(placed->drawn.data(), bytes);
    _bytesUploaded += bytes;
    return *list->buffer;
}

PlacedInstanceBuffers::Textures PlacedInstanceBuffers::textures(const std::shared_ptr<const PlacedInstances>& placed,
                                                                std::size_t maxTexels)
{
    forgetUnused();
    const std::size_t placementTexels = (placed->placements ? placed->placements->size() : 0) *
                                        SharedBlocks<AffineMatrix>::blockSize * POSE_TEXELS_PER_MATRIX;
    if (std::max(placementTexels, placed->drawn.size()) > maxTexels) return {};
    if (!placed->placements) return {listBuffer(placed).texture(), 0, 0};
    Crowd& crowd = _crowds[placed->crowd.get()];
    if (!crowd.placements.buffer)
        crowd = {placed->crowd,
                 {std::make_unique<BufferTexture>(*_gl, GL_RGBA32F_ARB)},
                 {std::make_unique<BufferTexture>(*_gl, GL_RGBA8)}};
    upload(placed->placements, crowd.placements);
    if (placed->tints) upload(placed->tints, crowd.tints);
    return {listBuffer(placed).texture(), crowd.placements.buffer->texture(),
            placed->tints ? crowd.tints.buffer->texture() : 0};
}

void PlacedInstanceBuffers::forgetUnused()
{
    for (auto crowd = _crowds.begin(); crowd != _crowds.end();)
    {
        if (!crowd->second.crowd.expired())
        {
            ++crowd;
            continue;
        }
        crowd->second.placements.buffer->release();
        crowd->second.tints.buffer->release();
        crowd = _crowds.erase(crowd);
    }
}

template <typename Function>
void PlacedInstanceBuffers::forEachBuffer(Function function)
{
    for (auto& [key, crowd] : _crowds)
    {
        function(*crowd.placements.buffer);
        function(*crowd.tints.buffer);
    }
    for (List& list : _lists)
        function(*list.buffer);
}

void PlacedInstanceBuffers::deleteAllGLObjects()
{
    forEachBuffer([](BufferTexture& buffer) { buffer.release(); });
    discardAllGLObjects();
}

void PlacedInstanceBuffers::discardAllGLObjects()
{
    forEachBuffer([](BufferTexture& buffer) { buffer.discard(); });
    _crowds.clear();
    _lists.clear();
}

} // namespace osgGpuAnimation
