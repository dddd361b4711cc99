// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/buffers/SharedBlocks.h>
#include <osgGpuAnimation/math/JointTransform.h>

#include <layout.glsl>

#include <osg/GLObjects>
#include <osg/State>

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Instances of a crowd in the order of their draws, as skin.glsl draws them: a snapshot for one camera. They share
/// poses, or, without placements, have a pose each, whose palette has their placement.
struct PlacedInstances
{
    /// An instance: 8 bytes in each frame.
    struct Drawn
    {
        std::uint32_t pose; ///< index in the PoseBatch
        /// Index in the crowd, so in the placements and tints; above it the number of its outfit.
        std::uint32_t instance;

        std::uint32_t index() const { return instance & POSE_DRAWN_INDEX_MASK; } ///< in the crowd
    };

    std::shared_ptr<const void> crowd;               ///< identifies the crowd, whose placements stay on the GPU
    std::vector<Drawn> drawn;                        ///< level by level, see OutfitLists
    std::size_t poseCount = 0;                       ///< above the poses of all
    SharedBlocks<AffineMatrix>::Snapshot placements; ///< from the character's space to that of the draw; may be null
    SharedBlocks<std::uint32_t>::Snapshot tints;     ///< see PoseBatch::setTint(); null: all are white
};

/// The buffers of PlacedInstances in one graphics context. Lists and blocks that have not changed are not uploaded
/// again. Call it on the draw side only, with the context current.
class PlacedInstanceBuffers : public osg::GraphicsObjectManager
{
public:
    /// Buffer textures; 0: the context cannot hold them.
    struct Textures
    {
        GLuint drawn = 0;      ///< RG32UI
        GLuint placements = 0; ///< RGBA32F, three texels each; 0: the palette has them
        GLuint tints = 0;      ///< RGBA8; 0: all are white
    };

    explicit PlacedInstanceBuffers(unsigned int contextId);

    static PlacedInstanceBuffers& of(osg::State& state);

    /// The textures with this content. maxTexels: of a buffer texture.
    Textures textures(const std::shared_ptr<const PlacedInstances>& placed, std::size_t maxTexels);

    std::uint64_t getBytesUploaded() const { return _bytesUploaded; } ///< so far

    void flushDeletedGLObjects(double, double&) override { forgetUnused(); }
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override;
    void discardAllGLObjects() override;

protected:
    ~PlacedInstanceBuffers() override = default;

private:
    /// A buffer with the content of a snapshot; null: with none.
    template <typename Element>
    struct Uploaded
    {
        std::unique_ptr<BufferTexture> buffer;
        typename SharedBlocks<Element>::Snapshot content{};
    };
    struct Crowd
    {
        std::weak_ptr<const void> crowd;
        Uploaded<AffineMatrix> placements;
        Uploaded<std::uint32_t> tints;
    };
    struct List
    {
        std::weak_ptr<const PlacedInstances> list;
        std::unique_ptr<BufferTexture> buffer;
    };

    template <typename Element>
    void upload(const typename SharedBlocks<Element>::Snapshot& content, Uploaded<Element>& uploaded);
    const BufferTexture& listBuffer(const std::shared_ptr<const PlacedInstances>& placed);
    void forgetUnused();
    template <typename Function>
    void forEachBuffer(Function function);

    osg::GLExtensions* _gl;
    std::map<const void*, Crowd> _crowds;
    std::vector<List> _lists;
    std::uint64_t _bytesUploaded = 0;
};

} // namespace osgGpuAnimation
