// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/SkinnedVertices.h>

#include <osg/RenderInfo>
#include <osg/StateSet>

namespace osgGpuAnimation
{

class PosePipeline;
class SkinnedGeometry;
struct PalettePlace;

/// Skins meshes into SkinnedVertices while it lives, on the draw side, when the palettes are there. What is there
/// already, by the same palette of the same mesh, stays.
class SkinOnceRun
{
public:
    explicit SkinOnceRun(osg::RenderInfo& renderInfo);
    ~SkinOnceRun();
    SkinOnceRun(const SkinOnceRun&) = delete;
    SkinOnceRun& operator=(const SkinOnceRun&) = delete;

    /// The mesh for all instances of the batch of that set and slot; for none where not all find room: they are
    /// skinned by their draws then.
    void skin(const SkinnedGeometry& mesh, const AnimationSet& set, std::size_t slot);

private:
    void use(osg::StateSet* stateSet);
    /// False where there is no room.
    bool fill(SkinnedVertices::Piece& piece, const SkinnedGeometry& mesh, const PalettePlace& first, std::size_t count);

    osg::RenderInfo& _renderInfo;
    SkinnedVertices& _skinned;
    const PosePipeline* _pipeline;
    osg::StateSet* _used = nullptr;
};

} // namespace osgGpuAnimation
