// SPDX-License-Identifier: MIT
#include "gltf/ModelBuilder.h"
#include <osgGpuAnimation/animation/Skin.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <sstream>

namespace osgGpuAnimation::gltf
{

namespace
{

tinygltf::Value valueOfJson(const nlohmann::json& json)
{
    using Value = tinygltf::Value;
    if (json.is_object())
    {
        Value::Object members;
        for (const auto& [name, member] : json.items())
            members[name] = valueOfJson(member);
        return Value(members);
    }
    if (json.is_array())
    {
        Value::Array elements;
        for (const nlohmann::json& element : json)
            elements.push_back(valueOfJson(element));
        return Value(elements);
    }
    if (json.is_string()) return Value(json.get<std::string>());
    if (json.is_boolean()) return Value(json.get<bool>());
    return json.is_number_integer() ? Value(json.get<int>()) : Value(json.get<double>());
}

} // namespace

tinygltf::Value valueOf(const std::string& json)
{
    return valueOfJson(nlohmann::json::parse(json));
}

ModelBuilder::ModelBuilder()
{
    model.asset.version = "2.0";
    model.scenes.resize(1);
    model.defaultScene = 0;
    model.buffers.resize(1);
}

int ModelBuilder::accessor(int type, int componentType, std::size_t count, const void* data, std::size_t bytes)
{
    std::vector<unsigned char>& buffer = model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = bytes;
    buffer.resize(buffer.size() + (bytes + 3) / 4 * 4);
    if (bytes > 0) std::memcpy(buffer.data() + view.byteOffset, data, bytes);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size());
    accessor.type = type;
    accessor.componentType = componentType;
    accessor.count = count;
    model.bufferViews.push_back(view);
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

int ModelBuilder::floats(int type, const std::vector<float>& numbers)
{
    const auto components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    const int index = accessor(type, TINYGLTF_COMPONENT_TYPE_FLOAT, numbers.size() / components, numbers.data(),
                               numbers.size() * sizeof(float));
    // Positions and times must have bounds.
    tinygltf::Accessor& made = model.accessors.back();
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
        if (i < components)
        {
            made.minValues.push_back(numbers[i]);
            made.maxValues.push_back(numbers[i]);
        }
        made.minValues[i % components] = std::min<double>(made.minValues[i % components], numbers[i]);
        made.maxValues[i % components] = std::max<double>(made.maxValues[i % components], numbers[i]);
    }
    return index;
}

int ModelBuilder::integers(int type, int componentType, const std::vector<unsigned int>& numbers)
{
    const auto size =
        static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType)));
    const auto components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    std::vector<unsigned char> bytes;
    for (const unsigned int number : numbers)
    {
        for (std::size_t i = 0; i < size; ++i)
            bytes.push_back(static_cast<unsigned char>(number >> 8 * i)); // glTF is little-endian
    }
    return accessor(type, componentType, numbers.size() / components, bytes.data(), bytes.size());
}

int ModelBuilder::mesh(const std::map<std::string, int>& attributes, int mode, int indices)
{
    tinygltf::Primitive primitive;
    primitive.attributes = attributes;
    primitive.mode = mode;
    primitive.indices = indices;
    tinygltf::Mesh mesh;
    mesh.name = "mesh" + std::to_string(model.meshes.size());
    mesh.primitives.push_back(primitive);
    model.meshes.push_back(mesh);
    return static_cast<int>(model.meshes.size()) - 1;
}

int ModelBuilder::triangle()
{
    return mesh({{"POSITION", floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 0, 1, 0})},
                 {"NORMAL", floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, 0, 1, 0, 0, 1})}});
}

int ModelBuilder::skinnedTriangle()
{
    const int index = triangle();
    primitive(index).attributes["JOINTS_0"] =
        integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    primitive(index).attributes["WEIGHTS_0"] =
        floats(TINYGLTF_TYPE_VEC4, {0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0});
    return index;
}

int ModelBuilder::node(const std::string& name, int parent, int mesh)
{
    tinygltf::Node node;
    node.name = name;
    node.mesh = mesh;
    model.nodes.push_back(node);
    const int index = static_cast<int>(model.nodes.size()) - 1;
    (parent < 0 ? model.scenes[0].nodes : at(parent).children).push_back(index);
    return index;
}

int ModelBuilder::lamp(const tinygltf::Light& light, const std::string& name, const std::vector<double>& place,
                       int parent)
{
    model.lights.push_back(light);
    return lamp(static_cast<int>(model.lights.size()) - 1, name, place, parent);
}

int ModelBuilder::lamp(int light, const std::string& name, const std::vector<double>& place, int parent)
{
    const int made = node(name, parent);
    at(made).translation = place;
    at(made).extensions["KHR_lights_punctual"] = valueOf("{\"light\":" + std::to_string(light) + "}");
    return made;
}

int ModelBuilder::texture(const std::string& picture)
{
    tinygltf::Texture texture;
    texture.name = "texture"; // without a member it is not written
    if (!picture.empty())
    {
        texture.source = static_cast<int>(model.images.size());
        model.images.emplace_back().image.assign(picture.begin(), picture.end());
    }
    model.textures.push_back(texture);
    return static_cast<int>(model.textures.size()) - 1;
}

int ModelBuilder::skin(const std::vector<int>& joints)
{
    tinygltf::Skin skin;
    skin.joints = joints;
    model.skins.push_back(skin);
    return static_cast<int>(model.skins.size()) - 1;
}

int ModelBuilder::animation(const std::string& name)
{
    model.animations.emplace_back();
    model.animations.back().name = name;
    return static_cast<int>(model.animations.size()) - 1;
}

void ModelBuilder::channel(int node, const std::string& path, const std::vector<float>& times, int type,
                           const std::vector<float>& values, const std::string& interpolation)
{
    tinygltf::Animation& animation = model.animations.back();
    tinygltf::AnimationSampler sampler;
    sampler.input = floats(TINYGLTF_TYPE_SCALAR, times);
    sampler.output = floats(type, values);
    sampler.interpolation = interpolation;
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
}

namespace
{

// tinygltf 2.9 writes a node's light and levels of detail from members of the node, and removes the extensions without
// them. The second function is for versions without the members.
template <typename Node>
auto setMembers(Node& node, int) -> decltype(void(node.light), void(node.lods))
{
    const auto light = node.extensions.find("KHR_lights_punctual"), lods = node.extensions.find("MSFT_lod");
    if (light != node.extensions.end()) node.light = light->second.Get("light").GetNumberAsInt();
    if (lods == node.extensions.end()) return;
    for (const tinygltf::Value& id : lods->second.Get("ids").template Get<tinygltf::Value::Array>())
        node.lods.push_back(id.GetNumberAsInt());
}

template <typename Node>
void setMembers(Node&, long)
{
}

} // namespace

std::string ModelBuilder::text() const
{
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    tinygltf::Model copy = model;
    if (copy.buffers[0].data.empty()) copy.buffers.clear();
    for (tinygltf::Node& node : copy.nodes)
        setMembers(node, 0);
    writer.WriteGltfSceneToStream(&copy, stream, false, false);
    return stream.str();
}

} // namespace osgGpuAnimation::gltf
