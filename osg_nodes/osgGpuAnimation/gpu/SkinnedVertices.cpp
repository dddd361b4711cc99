// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/SkinnedVertices.h>

#include <osg/ContextData>

namespace osgGpuAnimation
{

namespace
{

/// OSG flushes at the end of each camera's frame. What is freed too early is skinned again where it is needed.
constexpr unsigned int maxUnusedFlushes = 100;

} // namespace

SkinnedVertices::SkinnedVertices(unsigned int contextId)
    : osg::GraphicsObjectManager("SkinnedVertices", contextId), _gl(osg::GLExtensions::Get(contextId, true))
{
}

SkinnedVertices& SkinnedVertices::of(osg::State& state)
{
    return *osg::get<SkinnedVertices>(state.getContextID());
}

SkinnedVertices::Piece& SkinnedVertices::piece(const Subject& subject, std::size_t number)
{
    Skinned& skinned = _skinned[subject];
    skinned.unusedFlushes = 0;
    while (skinned.pieces.size() <= number)
        skinned.pieces.push_back(std::make_unique<Piece>(*_gl));
    return *skinned.pieces[number];
}

void SkinnedVertices::trim(const Subject& subject, std::size_t pieceCount)
{
    std::vector<std::unique_ptr<Piece>>& pieces = _skinned[subject].pieces;
    while (pieces.size() > pieceCount)
    {
        pieces.back()->vertices.release();
        pieces.pop_back();
    }
}

SkinnedVertices::Place SkinnedVertices::place(const Subject& subject, std::size_t instance) const
{
    const auto known = _skinned.find(subject);
    if (known == _skinned.end()) return {};
    for (const std::unique_ptr<Piece>& piece : known->second.pieces)
        if (instance >= piece->first && instance - piece->first < piece->count)
            return {piece->vertices.texture(), piece->first, piece->first + piece->count};
    return {};
}

std::size_t SkinnedVertices::bytes() const
{
    std::size_t bytes = 0;
    for (const auto& [subject, skinned] : _skinned)
        for (const std::unique_ptr<Piece>& piece : skinned.pieces)
            bytes += piece->vertices.capacity();
    return bytes;
}

bool SkinnedVertices::hasRoomFor(const Piece& piece, std::size_t bytes) const
{
    const std::size_t capacity = piece.vertices.capacity();
    return bytes <= capacity || this->bytes() - capacity + piece.vertices.capacityFor(bytes) <= _maxBytes;
}

void SkinnedVertices::release(std::uint64_t mesh)
{
    auto skinned = _skinned.lower_bound({mesh, nullptr, 0});
    while (skinned != _skinned.end() && skinned->first.mesh == mesh)
    {
        trim(skinned->first, 0);
        skinned = _skinned.erase(skinned);
    }
}

void SkinnedVertices::releaseUnused()
{
    for (auto skinned = _skinned.begin(); skinned != _skinned.end();)
    {
        if (++skinned->second.unusedFlushes <= maxUnusedFlushes)
        {
            ++skinned;
            continue;
        }
        trim(skinned->first, 0);
        skinned = _skinned.erase(skinned);
    }
}

void SkinnedVertices::deleteAllGLObjects()
{
    for (const auto& [subject, skinned] : _skinned)
        for (const std::unique_ptr<Piece>& piece : skinned.pieces)
            piece->vertices.release();
    _skinned.clear();
}

void SkinnedVertices::discardAllGLObjects()
{
    _skinned.clear();
}

} // namespace osgGpuAnimation
