// SPDX-License-Identifier: MIT
#include "gltf/import/Textures.h"

#include "gltf/data/MaterialMaps.h"
#include "gltf/data/Picture.h"
#include "gltf/file/Elements.h"

#include <osgGpuAnimation/looks/shading/Mipmaps.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// The pictures of the maps that are shown, each once. Base colours first: they show the most. Pictures without bytes
/// are ignored: loadDocument() has warned of them.
std::vector<int> wantedImages(const tinygltf::Model& model, bool allMaps)
{
    std::vector<MaterialMaps> materials;
    for (const tinygltf::Material& material : model.materials)
        materials.push_back(mapsOf(material, allMaps));
    std::vector<bool> isKnown(model.images.size());
    std::vector<int> wanted;
    for (const bool isBaseColor : {true, false})
        for (const MaterialMaps& material : materials)
            for (const MaterialMap& map : material.maps)
            {
                if (map.use != MapUse::Shown || (map.place == &PbrMaterial::baseColorMap) != isBaseColor) continue;
                const int image = elementOf(model.textures, map.texture).source;
                if (image < 0 || elementOf(isKnown, image)) continue;
                elementOf(isKnown, image) = true;
                if (!elementOf(model.images, image).image.empty()) wanted.push_back(image);
            }
    return wanted;
}

/// The texture format for an RGB or RGBA picture; GL has no sRGB format of 16 bits a channel.
GLint internalFormat(const osg::Image& image, ColorSpace space)
{
    const bool hasAlpha = image.getPixelFormat() == GL_RGBA;
    if (space == ColorSpace::Srgb) return hasAlpha ? GL_SRGB8_ALPHA8 : GL_SRGB8;
    if (image.getDataType() == GL_UNSIGNED_SHORT) return hasAlpha ? GL_RGBA16 : GL_RGB16;
    return hasAlpha ? GL_RGBA8 : GL_RGB8;
}

} // namespace

/// The decoding threads and their results.
class Textures::Decoding
{
public:
    using Decoded = Result<osg::ref_ptr<osg::Image>>;

    Decoding(const tinygltf::Model& model, bool allMaps)
    {
        for (const int index : wantedImages(model, allMaps))
        {
            _tasks.emplace_back([&bytes = elementOf(model.images, index).image] { return decodePicture(bytes); });
            _decoded.emplace(index, _tasks.back().get_future());
        }
        const std::size_t threads = std::min(
            {_tasks.size(), maxThreads, static_cast<std::size_t>(std::max(1u, std::thread::hardware_concurrency()))});
        _threads.reserve(threads);
        try
        {
            while (_threads.size() < threads)
                _threads.emplace_back(&Decoding::run, this);
        }
        catch (const std::system_error&)
        {
            if (_threads.empty()) run(); // no thread can be started: decode at once
        }
    }
    ~Decoding()
    {
        _stop = true;
        for (std::thread& thread : _threads)
            thread.join();
    }

    bool has(int index) const { return _decoded.count(index) > 0; }
    /// Waits for one of the pictures. Call it once for each.
    Decoded take(int index) { return _decoded.at(index).get(); }

private:
    /// A further thread brings less and less, and holds a decoder's memory.
    static constexpr std::size_t maxThreads = 4;

    void run()
    {
        for (std::size_t task = _next++; task < _tasks.size() && !_stop; task = _next++)
            _tasks[task](); // out of memory: take() throws it
    }

    std::vector<std::packaged_task<Decoded()>> _tasks;
    std::map<int, std::future<Decoded>> _decoded;
    std::atomic<std::size_t> _next{0}; ///< the first task that no thread has begun
    std::atomic<bool> _stop{false};
    std::vector<std::thread> _threads;
};

Textures::Textures(const tinygltf::Model& model, Report& report, bool allMaps, bool keepsEncoded)
    : _model(model), _report(report), _keepsEncoded(keepsEncoded), _decoding(std::make_unique<Decoding>(model, allMaps))
{
}

Textures::~Textures() = default;

osg::Texture2D* Textures::texture(int index, ColorSpace space)
{
    if (index < 0) return nullptr;
    const tinygltf::Texture& source = elementOf(_model.textures, index);
    const auto [place, isNew] = _textures.try_emplace({source.source, source.sampler, space});
    if (isNew) place->second = make(source, space);
    return place->second.get();
}

osg::Image* Textures::image(int index)
{
    if (!_decoding->has(index)) return nullptr;
    const auto [place, isNew] = _images.try_emplace(index);
    if (!isNew) return place->second.get();
    const std::string& name = elementOf(_model.images, index).name;
    const Decoding::Decoded decoded = _decoding->take(index);
    if (!decoded)
    {
        _report.warn(namedElement("images", index, name) + ": " + decoded.error().message +
                     "; white is shown in its place");
        return nullptr;
    }
    decoded.value()->setName(name);
    if (_keepsEncoded) keepEncoded(*decoded.value(), elementOf(_model.images, index).image);
    place->second = decoded.value();
    return place->second.get();
}

osg::ref_ptr<osg::Texture2D> Textures::make(const tinygltf::Texture& source, ColorSpace space)
{
    osg::Image* const picture = image(source.source);
    if (!picture) return nullptr;
    const tinygltf::Sampler sampler =
        source.sampler < 0 ? tinygltf::Sampler() : elementOf(_model.samplers, source.sampler);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(picture);
    if (space != ColorSpace::Display) texture->setInternalFormat(internalFormat(*picture, space));
    // For hosts that let each texture take the format of its picture, as SimGear does.
    if (space == ColorSpace::Srgb) picture->setInternalTextureFormat(texture->getInternalFormat());
    texture->setName(source.name.empty() ? picture->getName() : source.name);
    // glTF and OSG both use OpenGL's numbers; the schema has checked them, and -1 says that the file gives no filter.
    texture->setWrap(osg::Texture::WRAP_S, static_cast<osg::Texture::WrapMode>(sampler.wrapS));
    texture->setWrap(osg::Texture::WRAP_T, static_cast<osg::Texture::WrapMode>(sampler.wrapT));
    texture->setFilter(osg::Texture::MIN_FILTER, sampler.minFilter < 0
                                                     ? osg::Texture::LINEAR_MIPMAP_LINEAR
                                                     : static_cast<osg::Texture::FilterMode>(sampler.minFilter));
    generateMipmaps(*texture);
    texture->setFilter(osg::Texture::MAG_FILTER, sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST
                                                     ? osg::Texture::NEAREST
                                                     : osg::Texture::LINEAR);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

} // namespace osgGpuAnimation::gltf
