// SPDX-License-Identifier: MIT
#include "gltf/scene/Textures.h"

#include "gltf/data/Picture.h"
#include "gltf/file/Report.h"

#include <atomic>
#include <exception>
#include <future>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

/// The base colour pictures of all materials. LoadImages has warned of pictures without bytes.
std::set<int> wantedImages(const tinygltf::Model& model)
{
    std::set<int> wanted;
    for (const tinygltf::Material& material : model.materials)
    {
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        const int image = texture < 0 ? -1 : model.textures[static_cast<std::size_t>(texture)].source;
        if (image >= 0 && !model.images[static_cast<std::size_t>(image)].image.empty()) wanted.insert(image);
    }
    return wanted;
}

} // namespace

/// The decoding thread and its results.
class Textures::Decoding
{
public:
    using Decoded = Result<osg::ref_ptr<osg::Image>>;

    explicit Decoding(const tinygltf::Model& model)
    {
        for (const int index : wantedImages(model))
        {
            _tasks.emplace_back(&model.images[static_cast<std::size_t>(index)].image, std::promise<Decoded>());
            _decoded.emplace(index, _tasks.back().second.get_future());
        }
        if (_tasks.empty()) return;
        try
        {
            _thread = std::thread(&Decoding::run, this);
        }
        catch (const std::system_error&)
        {
            run(); // no thread can be started: decode at once
        }
    }
    ~Decoding()
    {
        _stop = true;
        if (_thread.joinable()) _thread.join();
    }

    bool has(int index) const { return _decoded.count(index) > 0; }
    /// Waits for one of the pictures. Call it once for each.
    Decoded take(int index) { return _decoded.at(index).get(); }

private:
    void run()
    {
        for (auto& [bytes, promise] : _tasks)
        {
            if (_stop) return;
            try
            {
                promise.set_value(decodePicture(*bytes));
            }
            catch (...)
            {
                promise.set_exception(std::current_exception()); // out of memory: take() throws it again
            }
        }
    }

    std::vector<std::pair<const std::vector<unsigned char>*, std::promise<Decoded>>> _tasks;
    std::map<int, std::future<Decoded>> _decoded;
    std::atomic<bool> _stop{false};
    std::thread _thread;
};

Textures::Textures(const tinygltf::Model& model, Report& report)
    : _model(model), _report(report), _decoding(std::make_unique<Decoding>(model))
{
}

Textures::~Textures() = default;

osg::Texture2D* Textures::texture(int index)
{
    if (index < 0) return nullptr;
    const auto [place, isNew] = _textures.try_emplace(index);
    if (isNew) place->second = make(_model.textures[static_cast<std::size_t>(index)]);
    return place->second.get();
}

osg::Image* Textures::image(int index)
{
    if (!_decoding->has(index)) return nullptr;
    const auto [place, isNew] = _images.try_emplace(index);
    if (!isNew) return place->second.get();
    const std::string& name = _model.images[static_cast<std::size_t>(index)].name;
    const Decoding::Decoded decoded = _decoding->take(index);
    if (!decoded)
    {
        _report.warn(namedElement("images", static_cast<std::size_t>(index), name) + ": " + decoded.error().message +
                     "; white is shown in its place");
        return nullptr;
    }
    decoded.value()->setName(name);
    place->second = decoded.value();
    return place->second.get();
}

osg::ref_ptr<osg::Texture2D> Textures::make(const tinygltf::Texture& source)
{
    osg::Image* picture = image(source.source);
    if (!picture) return nullptr;
    const tinygltf::Sampler sampler =
        source.sampler < 0 ? tinygltf::Sampler() : _model.samplers[static_cast<std::size_t>(source.sampler)];
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(picture);
    texture->setName(source.name.empty() ? picture->getName() : source.name);
    // glTF and OSG both use OpenGL's numbers; the schema has checked them, and -1 says that the file gives no filter.
    texture->setWrap(osg::Texture::WRAP_S, static_cast<osg::Texture::WrapMode>(sampler.wrapS));
    texture->setWrap(osg::Texture::WRAP_T, static_cast<osg::Texture::WrapMode>(sampler.wrapT));
    texture->setFilter(osg::Texture::MIN_FILTER, sampler.minFilter < 0
                                                     ? osg::Texture::LINEAR_MIPMAP_LINEAR
                                                     : static_cast<osg::Texture::FilterMode>(sampler.minFilter));
    texture->setFilter(osg::Texture::MAG_FILTER, sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST
                                                     ? osg::Texture::NEAREST
                                                     : osg::Texture::LINEAR);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

} // namespace osgGpuAnimation::gltf
