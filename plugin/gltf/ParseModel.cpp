// SPDX-License-Identifier: MIT
#include "gltf/ParseModel.h"

#include "gltf/ElementName.h"
#include "gltf/JsonWriter.h"
#include "gltf/PlainElements.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// The indices of the primitives, in the order of the document: tinygltf looks up their accessors, which it does not
/// get, and refuses those without a buffer view.
std::vector<int> takeIndices(const JsonValue& meshes)
{
    std::vector<int> taken;
    for (const JsonValue& mesh : meshes)
        for (const JsonValue& primitive : mesh["primitives"])
        {
            const JsonValue indices = primitive["indices"];
            taken.push_back(indices ? int(indices.number()) : -1);
            if (indices) indices.dropFrom(primitive);
        }
    return taken;
}

/// Puts back what takeIndices() took. False: there are more or fewer primitives than before.
bool giveIndices(const std::vector<int>& taken, tinygltf::Model& model)
{
    std::size_t next = 0;
    for (tinygltf::Mesh& mesh : model.meshes)
        for (tinygltf::Primitive& primitive : mesh.primitives)
        {
            if (next == taken.size()) return false;
            primitive.indices = taken[next++];
        }
    return next == taken.size();
}

/// Channels and samplers of an animation.
struct Tracks
{
    std::vector<tinygltf::AnimationChannel> channels;
    std::vector<tinygltf::AnimationSampler> samplers;
};

std::vector<Tracks> takeTracks(const JsonValue& animations)
{
    std::vector<Tracks> taken;
    if (animations) taken.reserve(animations.size());
    for (const JsonValue& animation : animations)
    {
        const JsonValue channels = animation["channels"], samplers = animation["samplers"];
        taken.push_back({readChannels(channels), readAnimationSamplers(samplers)});
        for (const JsonValue& list : {channels, samplers})
            if (list) list.dropFrom(animation);
    }
    return taken;
}

/// No file is tinygltf's to open.
tinygltf::FsCallbacks refuseFiles()
{
    return {[](const std::string&, void*) { return false; }, [](const std::string& path, void*) { return path; },
            [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; },
            [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }, nullptr};
}

bool keepImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*)
{
    return true;
}

std::optional<Error> runTinyGltf(const std::string& text, tinygltf::Model& model)
{
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keepImage, nullptr);
    loader.SetFsCallbacks(refuseFiles());
    std::string error, warning;
    // Text in `error` means nothing where the load succeeds: a skin without inverse bind matrices leaves some.
    if (loader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "", 0))
        return std::nullopt;
    return Error{"tinygltf refuses the document: " + (error.empty() ? "no reason is given" : printable(error, 200))};
}

template <typename Element>
std::optional<Error> compareSize(const JsonValue& json, const char* name, const std::vector<Element>& elements)
{
    const std::size_t expected = json ? json.size() : 0;
    if (elements.size() == expected) return std::nullopt;
    return fault(name, std::to_string(expected) + " elements after tinygltf has read them",
                 std::to_string(elements.size()));
}

/// tinygltf drops members that it does not like without a word; nothing here should be of that kind.
std::optional<Error> compareSizes(const JsonValue& document, const tinygltf::Model& model)
{
    std::optional<Error> error = compareSize(document["animations"], "animations", model.animations);
    if (!error) error = compareSize(document["meshes"], "meshes", model.meshes);
    if (!error) error = compareSize(document["nodes"], "nodes", model.nodes);
    if (!error) error = compareSize(document["skins"], "skins", model.skins);
    if (!error) error = compareSize(document["scenes"], "scenes", model.scenes);
    if (!error) error = compareSize(document["materials"], "materials", model.materials);
    if (!error) error = compareSize(document["textures"], "textures", model.textures);
    if (!error) error = compareSize(document["samplers"], "samplers", model.samplers);
    if (!error) error = compareSize(document["cameras"], "cameras", model.cameras);
    return error;
}

template <typename Element>
void reserve(const JsonValue& json, std::vector<Element>& elements)
{
    if (json) elements.reserve(json.size());
}

} // namespace

std::optional<Error> parseModel(const JsonValue& document, tinygltf::Model& model)
{
    const JsonValue accessors = document["accessors"], bufferViews = document["bufferViews"];
    for (const JsonValue& list : {accessors, bufferViews})
        if (list) list.dropFrom(document);
    std::vector<Tracks> tracks = takeTracks(document["animations"]);
    const std::vector<int> indices = takeIndices(document["meshes"]);

    // tinygltf's elements are half a kilobyte each and would be moved as its vectors grow.
    reserve(document["nodes"], model.nodes);
    reserve(document["meshes"], model.meshes);
    reserve(document["materials"], model.materials);
    reserve(document["textures"], model.textures);
    if (std::optional<Error> error = runTinyGltf(writeJson(document), model)) return error;
    if (std::optional<Error> error = compareSizes(document, model)) return error;

    model.accessors = readAccessors(accessors);
    model.bufferViews = readBufferViews(bufferViews);
    for (std::size_t i = 0; i < tracks.size(); ++i)
    {
        model.animations[i].channels = std::move(tracks[i].channels);
        model.animations[i].samplers = std::move(tracks[i].samplers);
    }
    if (giveIndices(indices, model)) return std::nullopt;
    return fault("meshes", std::to_string(indices.size()) + " primitives after tinygltf has read them", "others");
}

} // namespace osgGpuAnimation::gltf
