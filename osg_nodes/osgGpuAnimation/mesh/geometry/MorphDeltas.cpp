// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/MorphDeltas.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <layout.glsl>

#include <osg/observer_ptr>
#include <osg/Program>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// Writes one channel of one target to its texels.
template <typename Array>
void pack(const Array* array, std::size_t vertexCount, std::size_t stride, osg::Vec4f* out)
{
    if (!array) return;
    for (std::size_t vertex = 0; vertex < std::min(vertexCount, array->size()); ++vertex, out += stride)
        for (int i = 0; i < Array::ElementDataType::num_components; ++i)
            (*out)[i] = (*array)[vertex][i];
}

template <typename Array>
bool anyHas(const std::vector<MorphTarget>& targets, osg::ref_ptr<Array> MorphTarget::*channel)
{
    return std::any_of(targets.begin(), targets.end(), [=](const MorphTarget& target) { return target.*channel; });
}

/// The source of a texture: it keeps the arrays alive, so that no other array can have their addresses.
class PackedTargets : public osg::Referenced
{
public:
    explicit PackedTargets(const std::vector<MorphTarget>& targets) : _targets(targets) {}

private:
    std::vector<MorphTarget> _targets;
};

osg::ref_ptr<osg::TextureBuffer> packTexture(const std::vector<MorphTarget>& targets, std::size_t vertexCount,
                                             const std::array<int, 5>& channels)
{
    const std::size_t stride = targets.size() * static_cast<std::size_t>(channels[0]);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(std::max<std::size_t>(stride * vertexCount, 1)), 1, 1, GL_RGBA, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    auto* texels = reinterpret_cast<osg::Vec4f*>(image->data());
    std::fill(texels, texels + image->s(), osg::Vec4f());
    for (std::size_t i = 0; i < targets.size(); ++i)
    {
        osg::Vec4f* first = texels + i * static_cast<std::size_t>(channels[0]);
        pack(targets[i].positions.get(), vertexCount, stride, first);
        if (channels[1] >= 0) pack(targets[i].normals.get(), vertexCount, stride, first + channels[1]);
        if (channels[2] >= 0) pack(targets[i].colors.get(), vertexCount, stride, first + channels[2]);
        if (channels[3] >= 0) pack(targets[i].textureCoordinates.get(), vertexCount, stride, first + channels[3]);
        if (channels[4] >= 0) pack(targets[i].tangents.get(), vertexCount, stride, first + channels[4]);
    }
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer(image);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    texture->setUserData(new PackedTargets(targets));
    return texture;
}

/// The texture of those arrays while it is in use, or a new one.
osg::ref_ptr<osg::TextureBuffer> sharedTexture(const std::vector<MorphTarget>& targets, std::size_t vertexCount,
                                               const std::array<int, 5>& channels)
{
    /// The arrays with their modified counts, and the number of vertices.
    using Source = std::pair<std::vector<std::pair<const osg::Array*, unsigned int>>, std::size_t>;
    static std::mutex mutex;
    static std::map<Source, osg::observer_ptr<osg::TextureBuffer>> textures;
    Source source{{}, vertexCount};
    for (const MorphTarget& target : targets)
        for (const osg::Array* array :
             std::initializer_list<const osg::Array*>{target.positions.get(), target.normals.get(), target.colors.get(),
                                                      target.textureCoordinates.get(), target.tangents.get()})
            source.first.emplace_back(array, array ? array->getModifiedCount() : 0);
    const std::lock_guard<std::mutex> lock(mutex);
    osg::ref_ptr<osg::TextureBuffer> texture;
    if (const auto known = textures.find(source); known != textures.end() && known->second.lock(texture))
        return texture;
    for (auto unused = textures.begin(); unused != textures.end();)
        unused = unused->second.valid() ? std::next(unused) : textures.erase(unused);
    texture = packTexture(targets, vertexCount, channels);
    textures[std::move(source)] = texture;
    return texture;
}

} // namespace

MorphDeltas packMorphTargets(const std::vector<MorphTarget>& targets, std::size_t vertexCount)
{
    MorphDeltas deltas;
    std::array<int, 5>& channels = deltas.channels;
    if (anyHas(targets, &MorphTarget::normals)) channels[1] = channels[0]++;
    if (anyHas(targets, &MorphTarget::colors)) channels[2] = channels[0]++;
    if (anyHas(targets, &MorphTarget::textureCoordinates)) channels[3] = channels[0]++;
    if (anyHas(targets, &MorphTarget::tangents)) channels[4] = channels[0]++;

    deltas.texture = sharedTexture(targets, vertexCount, channels);
    return deltas;
}

bool bindMorphTargets(osg::State& state, const MorphDeltas& deltas, std::size_t targetCount, int entry)
{
    static const unsigned int deltasName = osg::Uniform::getNameID("poseMorphDeltas");
    static const unsigned int morphName = osg::Uniform::getNameID("poseMorph");
    static const unsigned int channelsName = osg::Uniform::getNameID("poseMorphChannels");
    static const unsigned int tangentsName = osg::Uniform::getNameID("poseMorphTangents");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return true;
    const GLint deltasLocation = program->getUniformLocation(deltasName);
    const PosePipeline* pipeline = PosePipeline::of(state);
    const bool fits = deltas.texture && pipeline &&
                      static_cast<std::size_t>(deltas.texture->getImage()->s()) <= pipeline->getMaxTexels();
    if (deltasLocation < 0) return fits || !deltas.texture; // a program without morph targets
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    gl->glUniform1i(deltasLocation, POSE_MORPH_UNIT);
    const GLint targets = fits ? static_cast<GLint>(targetCount) : 0;
    gl->glUniform2i(program->getUniformLocation(morphName), targets, entry);
    if (!fits) return !deltas.texture;
    state.applyTextureAttribute(POSE_MORPH_UNIT, deltas.texture.get());
    gl->glUniform4i(program->getUniformLocation(channelsName), deltas.channels[0], deltas.channels[1],
                    deltas.channels[2], deltas.channels[3]);
    gl->glUniform1i(program->getUniformLocation(tangentsName), deltas.channels[4]);
    return true;
}

} // namespace osgGpuAnimation
