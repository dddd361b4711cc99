// SPDX-License-Identifier: MIT
#include "GltfDocument.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace osgGpuAnimation::scenes
{

namespace
{

const char* const variantsExtension = "KHR_materials_variants";

double rounded(double value)
{
    const double steps = 1048576.0;
    return std::round(value * steps) / steps + 0.0; // + 0.0 turns -0 into 0
}

template <typename Vector>
std::vector<double> flattened(const std::vector<Vector>& vectors)
{
    std::vector<double> values;
    for (const Vector& vector : vectors)
        for (int component = 0; component < Vector::length(); ++component)
            values.push_back(rounded(vector[component]));
    return values;
}

} // namespace

GltfDocument::GltfDocument(const std::string& sceneName)
{
    _model.asset.version = "2.0";
    _model.asset.generator = "osgGpuAnimation make_scenes";
    _model.asset.copyright = "CC0 1.0";
    _model.buffers.resize(1);
    _model.scenes.resize(1);
    _model.scenes[0].name = sceneName;
    _model.defaultScene = 0;
}

int GltfDocument::addNode(const std::string& name, int parent, const glm::dvec3& translation,
                          const glm::dquat& rotation)
{
    const int index = static_cast<int>(_model.nodes.size());
    tinygltf::Node node;
    node.name = name;
    if (translation != glm::dvec3(0.0))
        node.translation = {rounded(translation.x), rounded(translation.y), rounded(translation.z)};
    if (std::abs(rotation.w) < 1.0 - 1e-12)
        node.rotation = {rounded(rotation.x), rounded(rotation.y), rounded(rotation.z), rounded(rotation.w)};
    _model.nodes.push_back(node);
    if (parent < 0)
        _model.scenes[0].nodes.push_back(index);
    else
        _model.nodes[parent].children.push_back(index);
    return index;
}

int GltfDocument::addTexture(const std::string& name, const std::vector<std::uint8_t>& png, bool repeats)
{
    tinygltf::Image image;
    image.name = name;
    image.mimeType = "image/png";
    image.bufferView = addView(png.data(), png.size(), 0);
    _model.images.push_back(image);

    tinygltf::Sampler sampler;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.wrapS = sampler.wrapT = repeats ? TINYGLTF_TEXTURE_WRAP_REPEAT : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    _model.samplers.push_back(sampler);

    tinygltf::Texture texture;
    texture.name = name;
    texture.source = static_cast<int>(_model.images.size()) - 1;
    texture.sampler = static_cast<int>(_model.samplers.size()) - 1;
    _model.textures.push_back(texture);
    return static_cast<int>(_model.textures.size()) - 1;
}

int GltfDocument::addMaterial(const tinygltf::Material& material)
{
    for (const auto& [name, value] : material.extensions)
        if (std::find(_model.extensionsUsed.begin(), _model.extensionsUsed.end(), name) == _model.extensionsUsed.end())
            _model.extensionsUsed.push_back(name);
    _model.materials.push_back(material);
    return static_cast<int>(_model.materials.size()) - 1;
}

int GltfDocument::addVariant(const std::string& name)
{
    tinygltf::Value::Array variants;
    const auto found = _model.extensions.find(variantsExtension);
    if (found == _model.extensions.end())
        _model.extensionsUsed.push_back(variantsExtension);
    else
        variants = found->second.Get("variants").Get<tinygltf::Value::Array>();
    variants.emplace_back(tinygltf::Value::Object{{"name", tinygltf::Value(name)}});
    const int index = static_cast<int>(variants.size()) - 1;
    _model.extensions[variantsExtension] =
        tinygltf::Value(tinygltf::Value::Object{{"variants", tinygltf::Value(std::move(variants))}});
    return index;
}

void GltfDocument::setVariantMaterial(int mesh, int variant, int material)
{
    tinygltf::Value::Array variants{tinygltf::Value(variant)};
    tinygltf::Value::Array mappings{tinygltf::Value(tinygltf::Value::Object{
        {"material", tinygltf::Value(material)}, {"variants", tinygltf::Value(std::move(variants))}})};
    _model.meshes[mesh].primitives.back().extensions[variantsExtension] =
        tinygltf::Value(tinygltf::Value::Object{{"mappings", tinygltf::Value(std::move(mappings))}});
}

int GltfDocument::addMesh(const std::string& name)
{
    tinygltf::Mesh mesh;
    mesh.name = name;
    _model.meshes.push_back(mesh);
    return static_cast<int>(_model.meshes.size()) - 1;
}

void GltfDocument::addPrimitive(int mesh, const PrimitiveArrays& arrays, int material)
{
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = material;

    const int vertices = TINYGLTF_TARGET_ARRAY_BUFFER;
    primitive.attributes["POSITION"] = addFloats(flattened(arrays.positions), TINYGLTF_TYPE_VEC3, vertices, true);
    primitive.attributes["NORMAL"] = addFloats(flattened(arrays.normals), TINYGLTF_TYPE_VEC3, vertices, false);
    if (!arrays.tangents.empty())
        primitive.attributes["TANGENT"] = addFloats(flattened(arrays.tangents), TINYGLTF_TYPE_VEC4, vertices, false);
    if (!arrays.textureCoordinates.empty())
        primitive.attributes["TEXCOORD_0"] =
            addFloats(flattened(arrays.textureCoordinates), TINYGLTF_TYPE_VEC2, vertices, false);
    if (!arrays.colours.empty())
        primitive.attributes["COLOR_0"] = addFloats(flattened(arrays.colours), TINYGLTF_TYPE_VEC3, vertices, false);
    if (!arrays.joints.empty())
    {
        const int view = addView(arrays.joints.data(), arrays.joints.size() * 4, vertices);
        primitive.attributes["JOINTS_0"] =
            addAccessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4, arrays.joints.size());
        std::vector<double> weights;
        for (const std::array<double, 4>& four : arrays.weights)
            weights.insert(weights.end(), four.begin(), four.end());
        primitive.attributes["WEIGHTS_0"] = addFloats(weights, TINYGLTF_TYPE_VEC4, vertices, false);
    }

    const std::vector<std::uint16_t> indices(arrays.indices.begin(), arrays.indices.end());
    const int view = addView(indices.data(), indices.size() * 2, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    primitive.indices = addAccessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, indices.size());
    _model.meshes[mesh].primitives.push_back(primitive);
}

int GltfDocument::addMeshLike(const std::string& name, int other, int material)
{
    const int mesh = addMesh(name);
    _model.meshes[mesh].primitives.push_back(_model.meshes[other].primitives.front());
    _model.meshes[mesh].primitives.front().material = material;
    return mesh;
}

int GltfDocument::addSkin(const std::string& name, const std::vector<int>& joints,
                          const std::vector<glm::dmat4>& inverseBinds, int skeleton)
{
    std::vector<double> values;
    for (const glm::dmat4& matrix : inverseBinds)
        for (int element = 0; element < 16; ++element)
            values.push_back(rounded(glm::value_ptr(matrix)[element]));
    tinygltf::Skin skin;
    skin.name = name;
    skin.joints = joints;
    skin.skeleton = skeleton;
    skin.inverseBindMatrices = addFloats(values, TINYGLTF_TYPE_MAT4, 0, false);
    _model.skins.push_back(skin);
    return static_cast<int>(_model.skins.size()) - 1;
}

int GltfDocument::addTimes(const std::vector<double>& times)
{
    return addFloats(times, TINYGLTF_TYPE_SCALAR, 0, true);
}

int GltfDocument::addAnimation(const std::string& name)
{
    tinygltf::Animation animation;
    animation.name = name;
    _model.animations.push_back(animation);
    return static_cast<int>(_model.animations.size()) - 1;
}

void GltfDocument::addMarker(int animation, double time, const std::string& name)
{
    tinygltf::Value& extras = _model.animations[animation].extras;
    tinygltf::Value::Array markers;
    if (extras.Has("markers")) markers = extras.Get("markers").Get<tinygltf::Value::Array>();
    markers.emplace_back(tinygltf::Value::Object{{"name", tinygltf::Value(name)}, {"time", tinygltf::Value(time)}});
    extras = tinygltf::Value(tinygltf::Value::Object{{"markers", tinygltf::Value(markers)}});
}

void GltfDocument::addTranslations(int animation, int node, int times, const std::vector<glm::dvec3>& values)
{
    addChannel(animation, node, "translation", times, addFloats(flattened(values), TINYGLTF_TYPE_VEC3, 0, false));
}

void GltfDocument::addRotations(int animation, int node, int times, const std::vector<glm::dquat>& values)
{
    std::vector<double> flat;
    for (const glm::dquat& value : values)
        flat.insert(flat.end(), {rounded(value.x), rounded(value.y), rounded(value.z), rounded(value.w)});
    addChannel(animation, node, "rotation", times, addFloats(flat, TINYGLTF_TYPE_VEC4, 0, false));
}

void GltfDocument::write(const std::string& path)
{
    // To a stream of our own: tinygltf's writing to a file does not notice that it cannot be opened.
    std::ofstream file(path, std::ios::binary);
    tinygltf::TinyGLTF writer;
    const bool pretty = false;
    const bool binary = true;
    if (!file || !writer.WriteGltfSceneToStream(&_model, file, pretty, binary) || !file.flush())
        throw std::runtime_error("cannot write " + path);
}

int GltfDocument::addView(const void* data, std::size_t bytes, int target)
{
    std::vector<unsigned char>& buffer = _model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = bytes;
    view.target = target;
    const auto* from = static_cast<const unsigned char*>(data);
    buffer.insert(buffer.end(), from, from + bytes);
    buffer.resize((buffer.size() + 3) / 4 * 4);
    _model.bufferViews.push_back(view);
    return static_cast<int>(_model.bufferViews.size()) - 1;
}

int GltfDocument::addAccessor(int view, int componentType, int type, std::size_t count)
{
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = componentType;
    accessor.type = type;
    accessor.count = count;
    _model.accessors.push_back(accessor);
    return static_cast<int>(_model.accessors.size()) - 1;
}

int GltfDocument::addFloats(const std::vector<double>& values, int type, int target, bool bounds)
{
    std::vector<float> floats;
    for (double value : values)
        floats.push_back(static_cast<float>(value));
    const std::size_t components = tinygltf::GetNumComponentsInType(type);
    const int view = addView(floats.data(), floats.size() * sizeof(float), target);
    const int index = addAccessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, type, floats.size() / components);
    if (!bounds) return index;

    tinygltf::Accessor& accessor = _model.accessors[index];
    accessor.minValues.assign(floats.begin(), floats.begin() + components);
    accessor.maxValues = accessor.minValues;
    for (std::size_t i = 0; i < floats.size(); ++i)
    {
        double& lower = accessor.minValues[i % components];
        double& upper = accessor.maxValues[i % components];
        lower = std::min<double>(lower, floats[i]);
        upper = std::max<double>(upper, floats[i]);
    }
    return index;
}

void GltfDocument::addChannel(int animation, int node, const std::string& path, int times, int values)
{
    tinygltf::Animation& target = _model.animations[animation];
    tinygltf::AnimationSampler sampler;
    sampler.input = times;
    sampler.output = values;
    sampler.interpolation = "LINEAR";
    target.samplers.push_back(sampler);

    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(target.samplers.size()) - 1;
    channel.target_node = node;
    channel.target_path = path;
    target.channels.push_back(channel);
}

} // namespace osgGpuAnimation::scenes
