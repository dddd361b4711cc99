// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/gpu/BufferTexture.h>

#include <osg/BufferObject>
#include <osg/GLObjects>
#include <osg/State>

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Meshes that were skinned once for all that draw them, in one graphics context: for all instances of a batch, one
/// after another, each vertex' position and maybe its normal, a texel (16 bytes) each. Instances are told by their
/// numbers in the batch. Only to be called on the draw side, with the context current.
class SkinnedVertices : public osg::GraphicsObjectManager
{
public:
    /// A mesh, by a number of its own, in the poses of the batch of that set and slot.
    struct Subject
    {
        std::uint64_t mesh;
        const AnimationSet* set;
        std::size_t slot;

        bool operator<(const Subject& other) const
        {
            return std::tie(mesh, set, slot) < std::tie(other.mesh, other.set, other.slot);
        }
    };

    /// The data a mesh consists of, and how often each was changed.
    using Versions = std::vector<std::pair<osg::ref_ptr<const osg::BufferData>, unsigned int>>;

    /// Some instances one behind the other: as many as lie in one chunk of the palette and fit a buffer texture.
    struct Piece
    {
        explicit Piece(osg::GLExtensions& gl) : vertices(gl, GL_RGBA32F_ARB) {}

        std::size_t first = 0;
        std::size_t count = 0;
        std::uint64_t evaluation = 0; ///< of the palette that it was skinned by
        Versions versions;            ///< of the mesh that was skinned
        BufferTexture vertices;
    };

    /// Where the draw side finds an instance.
    struct Place
    {
        GLuint texture = 0;    ///< 0: nowhere
        std::size_t first = 0; ///< the first instance of the texture
        std::size_t end = 0;   ///< behind the last
    };

    explicit SkinnedVertices(unsigned int contextId);

    static SkinnedVertices& of(osg::State& state);

    /// The piece of that number, to be filled; those behind it are for what is filled next.
    Piece& piece(const Subject& subject, std::size_t number);
    /// Forgets all pieces but so many.
    void trim(const Subject& subject, std::size_t pieceCount);
    Place place(const Subject& subject, std::size_t instance) const;

    /// Frees what is there of a mesh. As all of this, on the draw side.
    void release(std::uint64_t mesh);

    /// Whether all meshes together keep within maxBytes when the piece grows to that many bytes.
    bool hasRoomFor(const Piece& piece, std::size_t bytes) const;

    /// Bytes that all meshes together take at most: what is beyond it is skinned by every draw.
    void setMaxBytes(std::size_t bytes) { _maxBytes = bytes; }
    std::size_t maxBytes() const { return _maxBytes; } ///< default: 256 MiB
    /// Counted since the start: instances of meshes skinned.
    std::uint64_t instancesSkinned() const { return _instancesSkinned; }
    void count(std::size_t instances) { _instancesSkinned += instances; }
    std::size_t bytes() const; ///< that are taken now

    void flushDeletedGLObjects(double, double&) override { releaseUnused(); }
    void flushAllDeletedGLObjects() override { releaseUnused(); }
    void deleteAllGLObjects() override;
    void discardAllGLObjects() override;

protected:
    ~SkinnedVertices() override = default;

private:
    struct Skinned
    {
        std::vector<std::unique_ptr<Piece>> pieces;
        unsigned int unusedFlushes = 0;
    };

    void releaseUnused();

    osg::GLExtensions* _gl;
    std::map<Subject, Skinned> _skinned;
    std::size_t _maxBytes = std::size_t(256) << 20;
    std::uint64_t _instancesSkinned = 0;
};

} // namespace osgGpuAnimation
