// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/PosePalette.h>

#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>

#include <layout.glsl>

#include <algorithm>
#include <cstring>

namespace osgGpuAnimation
{

namespace
{

/// Uploads [first, first + count) of the source to a buffer with room for `room` elements; `uploaded` records its
/// content. True if the content changed. If at most half changed, as with one moving instance of many, only that part
/// is uploaded.
template <typename Element>
bool uploadChanged(const std::vector<Element>& source, std::size_t first, std::size_t count, std::size_t room,
                   std::vector<Element>& uploaded, BufferTexture& buffer, std::size_t& bytesUploaded)
{
    const std::size_t bytes = count * sizeof(Element);
    const Element* begin = source.data() + first;
    if (count > 0 && buffer.reserve(room * sizeof(Element))) uploaded.clear(); // new storage is empty
    if (uploaded.size() == count && (count == 0 || std::memcmp(uploaded.data(), begin, bytes) == 0)) return false;
    if (uploaded.size() == count)
    {
        const auto isSame = [&](std::size_t i) { return std::memcmp(&uploaded[i], begin + i, sizeof(Element)) == 0; };
        std::size_t from = 0, to = count;
        while (isSame(from))
            ++from;
        while (isSame(to - 1))
            --to;
        if (2 * (to - from) <= count)
        {
            std::copy(begin + from, begin + to, uploaded.begin() + static_cast<std::ptrdiff_t>(from));
            buffer.uploadPart(from * sizeof(Element), begin + from, (to - from) * sizeof(Element));
            bytesUploaded += (to - from) * sizeof(Element);
            return true;
        }
    }
    uploaded.assign(begin, begin + count);
    if (count == 0) return true;
    buffer.upload(begin, bytes);
    bytesUploaded += bytes;
    return true;
}

} // namespace

std::size_t PosePalette::widthOf(std::size_t size)
{
    constexpr std::size_t step = FeedbackPass::verticesOfFastest;
    return size < step ? size : (size + step - 1) / step * step;
}

PosePalette::Chunk::Chunk(osg::GLExtensions& gl)
    : samples(gl, GL_RGBA32UI_EXT), roots(gl, GL_RGBA32F_ARB), tints(gl, GL_RGBA8), posed(gl, GL_RGBA32UI_EXT),
      targets(gl, GL_RGBA32F_ARB), palette(gl, GL_RGBA32F_ARB)
{
}

bool PosePalette::Chunk::hasSamplesAsAttributes() const
{
    return sampleStride <= POSE_SAMPLES_AS_ATTRIBUTES;
}

void PosePalette::Chunk::bindInstances(osg::GLExtensions& gl, FeedbackVertexArrays::Names& arrays) const
{
    // Compatibility profiles require attribute 0, so one sample is bound even if the shader fetches all samples.
    const unsigned int sampleCount = hasSamplesAsAttributes() ? static_cast<unsigned int>(sampleStride) : 1u;
    if (arrays.samples != samples.serial() || arrays.sampleStride != sampleStride || arrays.sampleCount != sampleCount)
        samples.bindAttributes(POSE_SAMPLE_LOCATION, sampleCount, sampleStride * sizeof(BlendSample), 0, 0);
    for (unsigned int unused = sampleCount; unused < arrays.sampleCount; ++unused)
        gl.glDisableVertexAttribArray(POSE_SAMPLE_LOCATION + unused);
    arrays.samples = samples.serial();
    arrays.sampleStride = sampleStride;
    arrays.sampleCount = sampleCount;
    // One matrix for all instances is the first element for every GL instance, which is a palette entry.
    constexpr int never = 1 << 30;
    const int divisor = uploadedRootMatrices.empty() ? -1 : uploadedRootMatrices.size() == 1 ? never : 0;
    if (divisor >= 0 && (arrays.roots != roots.serial() || arrays.rootDivisor != divisor))
        roots.bindAttributes(POSE_ROOT_LOCATION, POSE_TEXELS_PER_MATRIX, sizeof(AffineMatrix), 0,
                             static_cast<unsigned int>(divisor));
    for (unsigned int row = 0; divisor < 0 && arrays.rootDivisor >= 0 && row < POSE_TEXELS_PER_MATRIX; ++row)
        gl.glDisableVertexAttribArray(POSE_ROOT_LOCATION + row);
    arrays.roots = roots.serial();
    arrays.rootDivisor = divisor;
}

std::size_t PosePalette::posedTexels(const PoseBatch& batch)
{
    return batch.maxPosed() * batch.set().trackCount() * POSE_TEXELS_PER_TRANSFORM;
}

/// Uploads the posed keyframes of the chunk that have changed. first: the chunk's first instance. True if one has.
bool PosePalette::uploadPosed(const PoseBatch& batch, std::size_t first, Chunk& chunk, std::size_t& bytesUploaded)
{
    chunk.firstPosed = batch.firstPosed(first);
    const std::size_t count = batch.firstPosed(first + chunk.size) - chunk.firstPosed;
    const std::size_t bytes = batch.set().trackCount() * POSE_TEXELS_PER_TRANSFORM * BufferTexture::texelBytes;
    const bool isOtherCount = chunk.uploadedPosed.size() != count;
    const auto keyframe = [&](std::size_t place) -> const PosedKeyframe&
    { return *batch.posed()[chunk.firstPosed + place]; };
    std::size_t changed = 0;
    if (count == 0)
        chunk.uploadedPosed.clear();
    else
        changed = uploadChangedUnits(
            chunk.posed, bytes, count, chunk.uploadedPosed, _posedTexels,
            [&](std::size_t place) { return keyframe(place).serial(); },
            [&](std::size_t place) -> const auto& { return keyframe(place).texels(); });
    bytesUploaded += changed;
    return changed > 0 || isOtherCount;
}

std::vector<PosePalette::Chunk*> PosePalette::upload(const PoseBatch& batch, std::size_t chunkCapacity,
                                                     std::size_t& bytesUploaded)
{
    std::vector<Chunk*> changed;
    _chunkCapacity = chunkCapacity;
    // Equal samples may have another mask: numbers of freed masks are used again.
    const auto isKnown = [&](const std::shared_ptr<const SetMask>& mask)
    { return !mask || (mask->number < _masks.size() && _masks[mask->number].lock() == mask); };
    if (!std::all_of(batch.masks().begin(), batch.masks().end(), isKnown)) invalidate();
    _masks.assign(batch.masks().begin(), batch.masks().end());
    const std::size_t stride = batch.sampleStride();
    const std::vector<AffineMatrix>& roots = batch.rootMatrices();
    const bool hasOwnRoots = roots.size() > 1;
    const bool hasTints = !batch.tints().empty();
    const std::size_t targetStride = batch.targets().empty() ? 0 : batch.targets().size() / batch.size();
    std::size_t index = 0;
    for (std::size_t first = 0; first < batch.size(); first += chunkCapacity, ++index)
    {
        if (index == _chunks.size()) _chunks.push_back(std::make_unique<Chunk>(*_gl));
        Chunk& chunk = *_chunks[index];
        const std::size_t size = std::min(chunkCapacity, batch.size() - first);
        bool isChanged = chunk.size != size || chunk.sampleStride != stride;
        chunk.size = size;
        chunk.width = widthOf(size);
        chunk.sampleStride = stride;
        isChanged |= uploadChanged(batch.samples(), first * stride, size * stride, chunk.width * stride,
                                   chunk.uploadedSamples, chunk.samples, bytesUploaded);
        isChanged |= uploadChanged(roots, hasOwnRoots ? first : 0, hasOwnRoots ? size : roots.size(),
                                   hasOwnRoots ? chunk.width : roots.size(), chunk.uploadedRootMatrices, chunk.roots,
                                   bytesUploaded);
        isChanged |= uploadPosed(batch, first, chunk, bytesUploaded);
        isChanged |= uploadChanged(batch.targets(), first * targetStride, size * targetStride,
                                   chunk.width * targetStride, chunk.uploadedTargets, chunk.targets, bytesUploaded);
        // Only the draw reads tints: the palette does not change.
        uploadChanged(batch.tints(), hasTints ? first : 0, hasTints ? size : 0, hasTints ? size : 0,
                      chunk.uploadedTints, chunk.tints, bytesUploaded);
        chunk.isEvaluated = chunk.isEvaluated && !isChanged;
        if (!chunk.isEvaluated) changed.push_back(&chunk);
    }
    for (; index < _chunks.size(); ++index)
        _chunks[index]->size = 0;
    return changed;
}

PalettePlace PosePalette::place(std::size_t instance) const
{
    const std::size_t index = instance / _chunkCapacity;
    if (index >= _chunks.size()) return {};
    const Chunk& chunk = *_chunks[index];
    if (!chunk.isEvaluated) return {};
    return {chunk.palette.texture(),
            static_cast<int>(chunk.width),
            static_cast<int>(instance % _chunkCapacity),
            chunk.uploadedTints.empty() ? 0 : chunk.tints.texture(),
            index * _chunkCapacity,
            index * _chunkCapacity + chunk.size};
}

AffineMatrix PosePalette::rootMatrix(std::size_t instance) const
{
    const std::size_t index = instance / _chunkCapacity;
    if (index >= _chunks.size()) return {};
    const std::vector<AffineMatrix>& roots = _chunks[index]->uploadedRootMatrices;
    const std::size_t place = roots.size() == 1 ? 0 : instance % _chunkCapacity;
    return place < roots.size() ? roots[place] : AffineMatrix();
}

void PosePalette::invalidate()
{
    for (const std::unique_ptr<Chunk>& chunk : _chunks)
        chunk->isEvaluated = false;
}

void PosePalette::release()
{
    for (const std::unique_ptr<Chunk>& chunk : _chunks)
        for (BufferTexture* buffer :
             {&chunk->samples, &chunk->roots, &chunk->tints, &chunk->posed, &chunk->targets, &chunk->palette})
            buffer->release();
    _chunks.clear();
}

} // namespace osgGpuAnimation
