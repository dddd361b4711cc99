// SPDX-License-Identifier: MIT
#include "gltf/Textures.h"

#include "gltf/NamedElement.h"

namespace osgGpuAnimation::gltf
{

namespace
{

osg::Texture::WrapMode wrapMode(int mode)
{
    switch (mode)
    {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return osg::Texture::CLAMP_TO_EDGE;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return osg::Texture::MIRROR;
    default:
        return osg::Texture::REPEAT;
    }
}

/// The numbers are OpenGL's in both; unknown ones and -1 (none) give `otherwise`.
osg::Texture::FilterMode filterMode(int filter, osg::Texture::FilterMode otherwise)
{
    switch (filter)
    {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
        return static_cast<osg::Texture::FilterMode>(filter);
    default:
        return otherwise;
    }
}

/// The base colour pictures of all materials. Those without bytes were warned about by the validation.
std::set<int> wantedImages(const tinygltf::Model& model)
{
    std::set<int> wanted;
    for (const tinygltf::Material& material : model.materials)
    {
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        if (texture < 0 || static_cast<std::size_t>(texture) >= model.textures.size()) continue;
        const int image = model.textures[static_cast<std::size_t>(texture)].source;
        if (image < 0 || static_cast<std::size_t>(image) >= model.images.size()) continue;
        if (!model.images[static_cast<std::size_t>(image)].image.empty()) wanted.insert(image);
    }
    return wanted;
}

} // namespace

Textures::Textures(const tinygltf::Model& model, DecodedBytes& budget, Report& report) : _model(model), _report(report)
{
    std::map<int, EncodedImage> encoded;
    for (const int index : wantedImages(model))
    {
        const Result<EncodedImage> image =
            EncodedImage::examine(model.images[static_cast<std::size_t>(index)].image, budget);
        if (image)
            encoded.emplace(index, image.value());
        else
            warn(index, image.error().message);
    }
    for (const auto& [index, image] : encoded)
        _pending.insert(index);
    _queue = std::make_unique<ImageQueue>(encoded);
}

void Textures::warn(int image, const std::string& why)
{
    const auto index = static_cast<std::size_t>(image);
    _report.warn(namedElement("images", index, _model.images[index].name) + ": " + why +
                 "; white is shown in its place");
}

osg::Texture2D* Textures::texture(int index)
{
    if (index < 0 || static_cast<std::size_t>(index) >= _model.textures.size()) return nullptr;
    const auto [place, isNew] = _textures.try_emplace(index);
    if (isNew) place->second = make(_model.textures[static_cast<std::size_t>(index)]);
    return place->second.get();
}

osg::Image* Textures::image(int index)
{
    if (_pending.erase(index) > 0)
    {
        const ImageQueue::Decoded decoded = _queue->take(index);
        if (decoded)
        {
            _images[index] = decoded.value();
            _images[index]->setName(_model.images[static_cast<std::size_t>(index)].name);
        }
        else
            warn(index, decoded.error().message);
    }
    const auto found = _images.find(index);
    return found == _images.end() ? nullptr : found->second.get();
}

osg::ref_ptr<osg::Texture2D> Textures::make(const tinygltf::Texture& source)
{
    osg::Image* picture = image(source.source);
    if (!picture) return nullptr;
    const bool hasSampler = source.sampler >= 0 && static_cast<std::size_t>(source.sampler) < _model.samplers.size();
    const tinygltf::Sampler sampler =
        hasSampler ? _model.samplers[static_cast<std::size_t>(source.sampler)] : tinygltf::Sampler();
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(picture);
    texture->setName(source.name.empty() ? picture->getName() : source.name);
    texture->setWrap(osg::Texture::WRAP_S, wrapMode(sampler.wrapS));
    texture->setWrap(osg::Texture::WRAP_T, wrapMode(sampler.wrapT));
    texture->setFilter(osg::Texture::MIN_FILTER, filterMode(sampler.minFilter, osg::Texture::LINEAR_MIPMAP_LINEAR));
    texture->setFilter(osg::Texture::MAG_FILTER,
                       filterMode(sampler.magFilter, osg::Texture::LINEAR) == osg::Texture::NEAREST
                           ? osg::Texture::NEAREST
                           : osg::Texture::LINEAR);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

} // namespace osgGpuAnimation::gltf
