// SPDX-License-Identifier: MIT
#include "gltf/ParseModel.h"

#include "gltf/ElementName.h"
#include "gltf/JsonWriter.h"

#include <cstddef>
#include <future>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

// From here on a second thread saves more than it costs.
const std::size_t manyValues = 10000;

/// The indices of a primitive that tinygltf would refuse, because their accessor has no buffer view.
struct HiddenIndices
{
    std::size_t mesh = 0;
    std::size_t primitive = 0;
    int accessor = -1;
};

std::vector<bool> accessorsWithView(const JsonValue& document)
{
    std::vector<bool> flags;
    for (const JsonValue& accessor : document["accessors"])
        flags.push_back(bool(accessor["bufferView"]));
    return flags;
}

std::vector<HiddenIndices> hideIndices(const JsonValue& document)
{
    const std::vector<bool> withView = accessorsWithView(document);
    std::vector<HiddenIndices> hidden;
    std::size_t m = 0;
    for (const JsonValue& mesh : document["meshes"])
    {
        std::size_t p = 0;
        for (const JsonValue& primitive : mesh["primitives"])
        {
            const JsonValue indices = primitive["indices"];
            if (indices && !withView[std::size_t(indices.number())])
            {
                hidden.push_back({m, p, int(indices.number())});
                indices.dropFrom(primitive);
            }
            ++p;
        }
        ++m;
    }
    return hidden;
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
    std::optional<Error> error = compareSize(document["accessors"], "accessors", model.accessors);
    if (!error) error = compareSize(document["bufferViews"], "bufferViews", model.bufferViews);
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
void reserve(const JsonValue& document, const char* name, std::vector<Element>& elements)
{
    if (const JsonValue json = document[name]) elements.reserve(json.size());
}

/// tinygltf's elements are half a kilobyte each and would be moved as its vectors grow: a fifth of its time.
void reserve(const JsonValue& document, tinygltf::Model& model)
{
    reserve(document, "accessors", model.accessors);
    reserve(document, "bufferViews", model.bufferViews);
    reserve(document, "nodes", model.nodes);
    reserve(document, "meshes", model.meshes);
}

std::optional<Error> parseAnimations(const JsonValue& animations, std::vector<tinygltf::Animation>& result)
{
    if (!animations) return std::nullopt;
    tinygltf::Model model;
    model.animations.reserve(animations.size());
    if (std::optional<Error> error = runTinyGltf("{\"animations\":" + writeJson(animations) + '}', model)) return error;
    result = std::move(model.animations);
    return compareSize(animations, "animations", result);
}

/// All but the animations.
std::optional<Error> parseRest(const JsonValue& document, tinygltf::Model& model)
{
    const std::vector<HiddenIndices> hidden = hideIndices(document);
    const std::string text = writeJson(document);
    reserve(document, model);
    if (std::optional<Error> error = runTinyGltf(text, model)) return error;
    if (std::optional<Error> error = compareSizes(document, model)) return error;
    for (const HiddenIndices& indices : hidden)
        model.meshes[indices.mesh].primitives[indices.primitive].indices = indices.accessor;
    return std::nullopt;
}

} // namespace

std::optional<Error> parseModel(const JsonValue& document, tinygltf::Model& model)
{
    const JsonValue animations = document["animations"];
    if (animations) animations.dropFrom(document);
    const bool beside = animations && animations.valuesBelow() >= manyValues;
    std::vector<tinygltf::Animation> parsed;
    // Each works on its own part of the tree. Where no thread is to be had, the call is made by get().
    std::future<std::optional<Error>> task =
        std::async(beside ? std::launch::async | std::launch::deferred : std::launch::deferred, parseAnimations,
                   animations, std::ref(parsed));
    std::optional<Error> error = parseRest(document, model);
    const std::optional<Error> animationError = task.get();
    model.animations = std::move(parsed);
    return error ? error : animationError;
}

} // namespace osgGpuAnimation::gltf
