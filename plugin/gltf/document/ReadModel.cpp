// SPDX-License-Identifier: MIT
#include "gltf/document/ReadModel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// read() changes nothing if the document has no such member: the constructors of tinygltf's elements set the defaults
/// of the specification.
struct ModelMembers
{
    /// Recurses as deep as the document, which readJson() limits.
    static tinygltf::Value valueOf(const JsonValue& json)
    {
        switch (json.type())
        {
        case JsonTree::Type::Null:
            return tinygltf::Value();
        case JsonTree::Type::Boolean:
            return tinygltf::Value(json.boolean());
        case JsonTree::Type::Number:
            if (json.isInteger() && std::abs(json.number()) <= static_cast<double>(std::numeric_limits<int>::max()))
                return tinygltf::Value(static_cast<int>(json.number()));
            return tinygltf::Value(json.number());
        case JsonTree::Type::String:
            return tinygltf::Value(std::string(json.text()));
        case JsonTree::Type::Array:
        {
            tinygltf::Value::Array array;
            array.reserve(json.size());
            for (const JsonValue& element : json)
                array.push_back(valueOf(element));
            return tinygltf::Value(std::move(array));
        }
        default:
            tinygltf::Value::Object object;
            for (const JsonValue& member : json)
                object.emplace(member.key(), valueOf(member));
            return tinygltf::Value(std::move(object));
        }
    }

    template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
    static void read(const JsonValue& json, Number& number)
    {
        if (json) number = Number(json.number()); // 1 for true
    }

    static void read(const JsonValue& json, std::string& text)
    {
        if (json) text = json.text();
    }

    static void read(const JsonValue& json, tinygltf::Value& value)
    {
        if (json) value = valueOf(json);
    }

    template <typename Value>
    static void read(const JsonValue& json, std::map<std::string, Value>& members)
    {
        for (const JsonValue& member : json)
            read(member, members[std::string(member.key())]);
    }

    template <typename Element>
    static void read(const JsonValue& json, std::vector<Element>& elements)
    {
        if (!json) return;
        elements.clear();
        elements.reserve(json.size());
        for (const JsonValue& element : json)
            read(element, elements.emplace_back());
    }

    /// The members of these names: readAll(json, "node", node, "path", path).
    template <typename Value, typename... Rest>
    static void readAll(const JsonValue& json, std::string_view name, Value& value, Rest&&... rest)
    {
        read(json[name], value);
        if constexpr (sizeof...(rest) > 0) readAll(json, std::forward<Rest>(rest)...);
    }

    static void read(const JsonValue& json, tinygltf::Accessor& accessor)
    {
        static constexpr std::pair<std::string_view, int> types[] = {
            {"SCALAR", TINYGLTF_TYPE_SCALAR}, {"VEC2", TINYGLTF_TYPE_VEC2}, {"VEC3", TINYGLTF_TYPE_VEC3},
            {"VEC4", TINYGLTF_TYPE_VEC4},     {"MAT2", TINYGLTF_TYPE_MAT2}, {"MAT3", TINYGLTF_TYPE_MAT3},
            {"MAT4", TINYGLTF_TYPE_MAT4}};
        const auto isType = [text = json["type"].text()](const auto& type) { return type.first == text; };
        accessor.type = std::find_if(std::begin(types), std::end(types), isType)->second;
        readAll(json, "bufferView", accessor.bufferView, "byteOffset", accessor.byteOffset, "componentType",
                accessor.componentType, "normalized", accessor.normalized, "count", accessor.count, "name",
                accessor.name);
        accessor.sparse = {};
        const JsonValue sparse = json["sparse"];
        if (!sparse) return;
        accessor.sparse.isSparse = true;
        read(sparse["count"], accessor.sparse.count);
        auto& indices = accessor.sparse.indices;
        readAll(sparse["indices"], "bufferView", indices.bufferView, "byteOffset", indices.byteOffset, "componentType",
                indices.componentType);
        auto& values = accessor.sparse.values;
        readAll(sparse["values"], "bufferView", values.bufferView, "byteOffset", values.byteOffset);
    }

    static void read(const JsonValue& json, tinygltf::BufferView& view)
    {
        readAll(json, "buffer", view.buffer, "byteOffset", view.byteOffset, "byteLength", view.byteLength, "byteStride",
                view.byteStride, "target", view.target, "name", view.name);
    }

    /// A channel without a target animates nothing.
    static void read(const JsonValue& json, tinygltf::AnimationChannel& channel)
    {
        const JsonValue target = json["target"];
        read(json["sampler"], channel.sampler);
        readAll(target, "node", channel.target_node, "path", channel.target_path);
        if (channel.target_path != pointerPath) return;
        channel.target_node = -1; // the specification forbids a node beside a pointer
        read(target["extensions"]["KHR_animation_pointer"]["pointer"], channel.extensions["KHR_animation_pointer"]);
    }

    static void read(const JsonValue& json, tinygltf::AnimationSampler& sampler)
    {
        readAll(json, "input", sampler.input, "output", sampler.output, "interpolation", sampler.interpolation);
    }

    static void read(const JsonValue& json, tinygltf::Animation& animation)
    {
        readAll(json, "channels", animation.channels, "samplers", animation.samplers, "name", animation.name, "extras",
                animation.extras);
    }

    static void readVariants(const JsonValue& extensions, tinygltf::ExtensionMap& outExtensions)
    {
        const char* const name = "KHR_materials_variants";
        if (const JsonValue variants = extensions[name]) read(variants, outExtensions[name]);
    }

    static void read(const JsonValue& json, tinygltf::Primitive& primitive)
    {
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        readAll(json, "attributes", primitive.attributes, "indices", primitive.indices, "material", primitive.material,
                "mode", primitive.mode, "targets", primitive.targets);
        readVariants(json["extensions"], primitive.extensions);
    }

    static void read(const JsonValue& json, tinygltf::Mesh& mesh)
    {
        readAll(json, "primitives", mesh.primitives, "weights", mesh.weights, "name", mesh.name, "extras", mesh.extras);
    }

    static void read(const JsonValue& json, tinygltf::Node& node)
    {
        readAll(json, "camera", node.camera, "children", node.children, "skin", node.skin, "mesh", node.mesh, "matrix",
                node.matrix, "translation", node.translation, "rotation", node.rotation, "scale", node.scale, "weights",
                node.weights, "name", node.name, "extensions", node.extensions, "extras", node.extras);
    }

    static void read(const JsonValue& json, tinygltf::Scene& scene)
    {
        readAll(json, "nodes", scene.nodes, "name", scene.name, "extras", scene.extras);
    }

    static void read(const JsonValue& json, tinygltf::Skin& skin)
    {
        readAll(json, "inverseBindMatrices", skin.inverseBindMatrices, "joints", skin.joints, "skeleton", skin.skeleton,
                "name", skin.name);
    }

    static void read(const JsonValue& json, tinygltf::Texture& texture)
    {
        readAll(json, "sampler", texture.sampler, "source", texture.source, "name", texture.name);
        read(json["extensions"]["EXT_texture_webp"]["source"], texture.source); // `source` is for readers without WebP
    }

    static void read(const JsonValue& json, tinygltf::Sampler& sampler)
    {
        readAll(json, "magFilter", sampler.magFilter, "minFilter", sampler.minFilter, "wrapS", sampler.wrapS, "wrapT",
                sampler.wrapT, "name", sampler.name);
    }

    /// Info: one of tinygltf's three types for a texture of a material.
    template <typename Info>
    static void readTextureInfo(const JsonValue& json, Info& texture)
    {
        readAll(json, "index", texture.index, "texCoord", texture.texCoord, "extensions", texture.extensions);
    }

    static void read(const JsonValue& json, tinygltf::Material& material)
    {
        const JsonValue surface = json["pbrMetallicRoughness"];
        tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        material.emissiveFactor = {0.0, 0.0, 0.0};
        readAll(surface, "baseColorFactor", pbr.baseColorFactor, "metallicFactor", pbr.metallicFactor,
                "roughnessFactor", pbr.roughnessFactor);
        readAll(json, "emissiveFactor", material.emissiveFactor, "alphaMode", material.alphaMode, "alphaCutoff",
                material.alphaCutoff, "doubleSided", material.doubleSided, "name", material.name, "extensions",
                material.extensions, "extras", material.extras);
        readTextureInfo(surface["baseColorTexture"], pbr.baseColorTexture);
        readTextureInfo(surface["metallicRoughnessTexture"], pbr.metallicRoughnessTexture);
        readTextureInfo(json["normalTexture"], material.normalTexture);
        readTextureInfo(json["occlusionTexture"], material.occlusionTexture);
        readTextureInfo(json["emissiveTexture"], material.emissiveTexture);
        read(json["normalTexture"]["scale"], material.normalTexture.scale);
        read(json["occlusionTexture"]["strength"], material.occlusionTexture.strength);
    }

    /// A camera or light without a type is left out.
    static void read(const JsonValue& json, tinygltf::Camera& camera)
    {
        readAll(json, "type", camera.type, "name", camera.name);
        read(json["perspective"]["yfov"], camera.perspective.yfov);
        read(json["orthographic"]["ymag"], camera.orthographic.ymag);
    }

    static void read(const JsonValue& json, tinygltf::Light& light)
    {
        light.color = {1.0, 1.0, 1.0};
        readAll(json, "type", light.type, "name", light.name, "color", light.color, "intensity", light.intensity,
                "range", light.range);
        readAll(json["spot"], "innerConeAngle", light.spot.innerConeAngle, "outerConeAngle", light.spot.outerConeAngle);
    }
};

} // namespace

tinygltf::Model readModel(const JsonValue& document)
{
    tinygltf::Model model;
    ModelMembers::readAll(document, "accessors", model.accessors, "bufferViews", model.bufferViews, "animations",
                          model.animations, "meshes", model.meshes, "nodes", model.nodes, "scenes", model.scenes,
                          "scene", model.defaultScene, "skins", model.skins, "materials", model.materials, "textures",
                          model.textures, "samplers", model.samplers, "cameras", model.cameras, "extensionsUsed",
                          model.extensionsUsed, "extensionsRequired", model.extensionsRequired);
    ModelMembers::readAll(document["asset"], "version", model.asset.version, "generator", model.asset.generator,
                          "copyright", model.asset.copyright);
    ModelMembers::read(document["extensions"]["KHR_lights_punctual"]["lights"], model.lights);
    ModelMembers::readVariants(document["extensions"], model.extensions);
    return model;
}

} // namespace osgGpuAnimation::gltf
