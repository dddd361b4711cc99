// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SkinOnceRun.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/SkinOncePass.h>

#include <layout.glsl>

#include <osg/Texture>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

SkinnedVertices::Versions versionsOf(const SkinnedGeometry& mesh)
{
    SkinnedVertices::Versions versions;
    const auto add = [&](const osg::BufferData* data)
    { versions.emplace_back(data, data ? data->getModifiedCount() : 0u); };
    add(mesh.getVertexArray());
    add(mesh.getNormalArray());
    for (unsigned int influenceSet = 0; influenceSet < SkinnedGeometry::maxInfluenceSets; ++influenceSet)
    {
        add(mesh.entries(influenceSet));
        add(mesh.weights(influenceSet));
    }
    add(mesh.morphDeltas() ? mesh.morphDeltas()->getImage() : nullptr);
    versions.emplace_back(nullptr, static_cast<unsigned int>(mesh.rigidEntry()));
    versions.emplace_back(nullptr, static_cast<unsigned int>(mesh.morphEntry()));
    return versions;
}

} // namespace

SkinOnceRun::SkinOnceRun(osg::RenderInfo& renderInfo)
    : _renderInfo(renderInfo), _skinned(SkinnedVertices::of(*renderInfo.getState())),
      _pipeline(PosePipeline::of(*renderInfo.getState()))
{
}

SkinOnceRun::~SkinOnceRun()
{
    if (_used) use(nullptr);
}

void SkinOnceRun::use(osg::StateSet* stateSet)
{
    if (stateSet == _used) return;
    osg::State& state = *_renderInfo.getState();
    if (_used)
        state.popStateSet();
    else
    {
        // What feedback writes must not be bound anywhere else.
        state.setActiveTextureUnit(POSE_SKINNED_UNIT);
        glBindTexture(GL_TEXTURE_BUFFER, 0);
    }
    if (stateSet) state.pushStateSet(stateSet);
    state.apply();
    _used = stateSet;
}

void SkinOnceRun::skin(const SkinnedGeometry& mesh, const AnimationSet& set, std::size_t slot)
{
    const std::size_t texels = mesh.skinnedTexelCount();
    const std::size_t capacity = _pipeline && texels > 0 ? _pipeline->maxTexels() / texels : 0;
    if (capacity == 0) return;
    const SkinnedVertices::Subject subject{mesh.number(), &set, slot};
    const SkinnedVertices::Versions versions = versionsOf(mesh);
    const std::size_t instances = _pipeline->instanceCount(set, slot);
    std::size_t number = 0;
    for (std::size_t first = 0; first < instances; ++number)
    {
        const PalettePlace place = _pipeline->place(set, slot, first);
        if (place.texture == 0) break;
        const std::size_t count = std::min(place.chunkEnd - first, capacity);
        SkinnedVertices::Piece& piece = _skinned.piece(subject, number);
        const bool isThere = piece.first == first && piece.count == count && piece.evaluation == place.evaluation &&
                             piece.versions == versions;
        if (!isThere)
        {
            piece.first = first;
            piece.versions = versions;
            if (!fill(piece, mesh, place, count)) return _skinned.trim(subject, 0);
        }
        first += count;
    }
    _skinned.trim(subject, number);
}

bool SkinOnceRun::fill(SkinnedVertices::Piece& piece, const SkinnedGeometry& mesh, const PalettePlace& first,
                       std::size_t count)
{
    const std::size_t bytes = count * mesh.skinnedTexelCount() * BufferTexture::texelBytes;
    if (!_skinned.hasRoomFor(piece, bytes)) return false;
    use(SkinOncePass::shared()->state(mesh.onceVariant()));
    // Making room binds to the unit that is active, which must be none that OSG keeps a record of.
    _renderInfo.getState()->setActiveTextureUnit(POSE_SKINNED_UNIT);
    piece.vertices.reserve(bytes);
    mesh.captureVertices(_renderInfo, first, static_cast<int>(count), piece.vertices.buffer());
    piece.count = count;
    piece.evaluation = first.evaluation;
    _skinned.count(count);
    return true;
}

} // namespace osgGpuAnimation
