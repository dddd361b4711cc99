// SPDX-License-Identifier: MIT
#include "gltf/data/AnimationPointers.h"

#include "gltf/document/ReadModel.h"
#include "gltf/file/Elements.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Object = PropertyMember::Object;

const char* const extensionName = "KHR_animation_pointer";
const char* const weightName = "weight";
constexpr std::size_t maxVisited = 65536; // nodes of all pointers: many may show one mesh

const char* const nameOfObject[] = {"materials", "extensions.KHR_lights_punctual.lights", "cameras", "nodes"};

/// `/nodes/3/translation`, `/nodes/3/weights/1`, `/meshes/0/weights`.
struct TransformPointer
{
    bool isMesh = false;
    int index = 0;
    std::string path;
    int weight = -1; ///< -1: all
};

std::optional<TransformPointer> parseTransform(std::string_view pointer)
{
    TransformPointer result;
    for (const auto& [prefix, isMesh] : {std::pair("/nodes/", false), std::pair("/meshes/", true)})
    {
        const std::string_view start(prefix);
        if (pointer.substr(0, start.size()) != start) continue;
        const std::string_view rest = pointer.substr(start.size());
        const std::size_t slash = rest.find('/');
        const std::optional<int> index = parsePointerIndex(rest.substr(0, slash));
        if (!index || slash == std::string_view::npos) return std::nullopt;
        const std::string_view path = rest.substr(slash + 1);
        result.isMesh = isMesh;
        result.index = *index;
        result.path = path.substr(0, path.find('/'));
        if (result.path != path) // an element
        {
            const std::optional<int> weight = parsePointerIndex(path.substr(result.path.size() + 1));
            if (!weight || result.path != "weights") return std::nullopt;
            result.weight = *weight;
        }
        const bool isTransform = result.path == "translation" || result.path == "rotation" || result.path == "scale";
        if (result.path == "weights" || (isTransform && !isMesh)) return result;
    }
    return std::nullopt;
}

std::vector<JsonValue> elementsOf(const JsonValue& array)
{
    std::vector<JsonValue> elements;
    for (const JsonValue& element : array)
        elements.push_back(element);
    return elements;
}

/// The value below; missing if there is none. path: separated by slashes.
JsonValue below(JsonValue value, std::string_view path)
{
    while (value && !path.empty())
    {
        const std::size_t slash = std::min(path.find('/'), path.size());
        value = value[path.substr(0, slash)];
        path.remove_prefix(std::min(slash + 1, path.size()));
    }
    return value;
}

void setNumber(tinygltf::Material& material, const char* extension, const char* member, tinygltf::Value number)
{
    tinygltf::Value& value = material.extensions[extension];
    tinygltf::Value::Object members =
        value.IsObject() ? value.Get<tinygltf::Value::Object>() : tinygltf::Value::Object();
    members[member] = std::move(number);
    value = tinygltf::Value(std::move(members));
}

class PointerResolver
{
public:
    PointerResolver(const JsonValue& document, tinygltf::Model& model, Report& report)
        : _model(model), _report(report), _objects{elementsOf(document["materials"]),
                                                   elementsOf(document["extensions"]["KHR_lights_punctual"]["lights"]),
                                                   elementsOf(document["cameras"]), elementsOf(document["nodes"])}
    {
    }

    void run()
    {
        for (std::size_t a = 0; a < _model.animations.size(); ++a)
        {
            _animation = &_model.animations[a];
            _taken.clear();
            for (const tinygltf::AnimationChannel& channel : _animation->channels)
                if (channel.target_node >= 0) _taken[{channel.target_node, channel.target_path}].insert(-1);
            for (std::size_t c = 0; c < _animation->channels.size(); ++c)
                resolve(a, c);
            _animation->channels.insert(_animation->channels.end(), _added.begin(), _added.end());
            _added.clear();
        }
        if (!_rest.empty()) _model.extensions[extensionName] = tinygltf::Value(std::move(_rest));
    }

private:
    void resolve(std::size_t animation, std::size_t channel)
    {
        _channel = &_animation->channels[channel];
        if (_channel->target_path != pointerPath) return;
        _name = elementName("animations", animation, "channels", channel);
        _pointer = _channel->extensions[extensionName].Get<std::string>();
        if (const std::optional<TransformPointer> transform = parseTransform(_pointer))
            resolveTransform(*transform);
        else if (const std::optional<PropertyPointer> property = PropertyPointer::parse(_pointer))
            resolveProperty(*property);
        else
            refuse("it points to nothing that is drawn");
    }

    void resolveTransform(const TransformPointer& pointer)
    {
        const std::string fault = faultOf(pointer);
        if (!fault.empty()) return refuse(fault);
        if (!_taken.try_emplace({-1, _pointer}).second) return refuse("another channel animates it");
        const std::size_t before = _added.size();
        addNodes(pointer);
        if (_visitedCount == maxVisited)
            return refuse("the file's pointers move more than " + std::to_string(maxVisited) + " nodes");
        if (_added.size() == before)
            return refuse(pointer.isMesh
                              ? "no node shows the mesh with its own weights, or another channel animates them"
                              : "another channel animates it");
        *_channel = std::move(_added.back());
        _added.pop_back();
    }

    void resolveProperty(const PropertyPointer& pointer)
    {
        const std::string fault = faultOf(pointer);
        if (!fault.empty()) return refuse(fault);
        if (!_taken.try_emplace({-1, _pointer}).second) return refuse("another channel animates it");
        _channel->target_path = _pointer;
        keepRest(*pointer.member, pointer.index);
        for (const PropertyMember& member : PropertyMember::all())
            if (!member.group.empty() && member.group == pointer.member->group &&
                member.object == pointer.member->object)
                keepRest(member, pointer.index);
        keepEffect(pointer);
    }

    /// Those that show the mesh with its own weights.
    const std::vector<int>& nodesOf(int mesh)
    {
        if (_nodesOfMesh.empty())
            for (std::size_t node = 0; node < _model.nodes.size(); ++node)
                if (_model.nodes[node].weights.empty())
                    _nodesOfMesh[_model.nodes[node].mesh].push_back(static_cast<int>(node));
        return _nodesOfMesh[mesh];
    }

    void addNodes(const TransformPointer& pointer)
    {
        for (const int index : pointer.isMesh ? nodesOf(pointer.index) : std::vector<int>{pointer.index})
        {
            if (_visitedCount == maxVisited) return;
            ++_visitedCount;
            if (isTaken(index, pointer.path, pointer.weight)) continue;
            _taken[{index, pointer.path}].insert(pointer.weight);
            tinygltf::AnimationChannel channel = *_channel;
            channel.target_node = index;
            channel.target_path = pointer.path;
            if (pointer.weight >= 0) channel.target_extensions[weightName] = tinygltf::Value(pointer.weight);
            _added.push_back(std::move(channel));
        }
    }

    std::string faultOf(const TransformPointer& pointer) const
    {
        const std::size_t count = pointer.isMesh ? _model.meshes.size() : _model.nodes.size();
        const auto index = static_cast<std::size_t>(pointer.index);
        if (index >= count)
            return "expected an index below " + std::to_string(count) + " of the file's " +
                   (pointer.isMesh ? "meshes" : "nodes") + ", found " + std::to_string(index);
        if (pointer.path != "weights") return "";
        const int mesh = pointer.isMesh ? pointer.index : _model.nodes[index].mesh;
        const std::size_t targets = mesh < 0 ? 0 : targetsOf(mesh);
        if (targets == 0) return "expected a mesh with morph targets, found none";
        if (pointer.weight >= 0 && static_cast<std::size_t>(pointer.weight) >= targets)
            return "expected a weight below " + std::to_string(targets) + ", found " + std::to_string(pointer.weight);
        return "";
    }

    std::string faultOf(const PropertyPointer& pointer) const
    {
        const PropertyMember& member = *pointer.member;
        const std::vector<JsonValue>& all = objects(member.object);
        if (static_cast<std::size_t>(pointer.index) >= all.size())
            return "expected an index below " + std::to_string(all.size()) + " of " +
                   nameOfObject[static_cast<std::size_t>(member.object)] + ", found " + std::to_string(pointer.index);
        const JsonValue object = elementOf(all, pointer.index);
        if (member.object == Object::Material) return faultOfMaterial(pointer);
        if (member.object == Object::Node) return "";
        if (!object["type"]) return "it was left out"; // for a fault of its own
        if (member.object == Object::Camera && member.name.find(object["type"].text()) != 0)
            return "the camera is not such";
        if (member.name.find("spot/") == 0 && object["type"].text() != "spot") return "the light is no spot";
        return "";
    }

    std::string faultOfMaterial(const PropertyPointer& pointer) const
    {
        const JsonValue material = elementOf(objects(Object::Material), pointer.index);
        if (pointer.member->name == "alphaCutoff" && (!material["alphaMode"] || material["alphaMode"].text() != "MASK"))
            return "the material's alphaMode is not MASK";
        if (pointer.member->texture.empty() || below(material, pointer.member->texture + "/index")) return "";
        return "the material has no such texture";
    }

    bool isTaken(int node, const std::string& path, int weight) const
    {
        const auto found = _taken.find({node, path});
        return found != _taken.end() && (weight < 0 || found->second.count(-1) > 0 || found->second.count(weight) > 0);
    }

    std::size_t targetsOf(int mesh) const
    {
        const auto& primitives = elementOf(_model.meshes, mesh).primitives;
        return primitives.empty() ? 0 : primitives.front().targets.size();
    }

    void refuse(const std::string& why)
    {
        _report.warn(_name + ".target: pointer " + '"' + printable(_pointer, 160) + "\": " + why + "; channel ignored");
        dropTarget(*_channel);
    }

    void keepRest(const PropertyMember& member, int index)
    {
        const std::string pointer = PropertyPointer::text(member, index);
        if (_rest.count(pointer) > 0) return;
        const JsonValue value = below(elementOf(objects(member.object), index), member.name);
        std::vector<JsonValue> given = elementsOf(value);
        if (value && !value.is(JsonTree::Type::Array)) given = {value}; // 1 for true
        tinygltf::Value::Array rest;
        for (std::size_t i = 0; i < member.count; ++i)
            rest.emplace_back(i < given.size() ? given[i].number() : static_cast<double>(member.rest[i]));
        _rest[pointer] = tinygltf::Value(std::move(rest));
    }

    /// PbrMaterial::hasEffect() and applyPbrMaterial() leave out what has no effect at rest.
    void keepEffect(const PropertyPointer& pointer)
    {
        constexpr double min = 1e-6;
        static constexpr struct
        {
            const char *extension, *member;
            double withoutEffect, withEffect;
        } factors[] = {{"KHR_materials_clearcoat", "clearcoatFactor", 0.0, min},
                       {"KHR_materials_transmission", "transmissionFactor", 0.0, min},
                       {"KHR_materials_sheen", "sheenColorFactor", 0.0, min},
                       {"KHR_materials_emissive_strength", "emissiveStrength", 1.0, 1.0 + min}};
        if (pointer.member->object != Object::Material) return;
        tinygltf::Material& material = elementOf(_model.materials, pointer.index);
        const tinygltf::Value::Array& rest =
            _rest[PropertyPointer::text(*pointer.member, pointer.index)].Get<tinygltf::Value::Array>();
        const std::string& name = pointer.member->name;
        for (const auto& factor : factors)
        {
            const auto isWithoutEffect = [&](const tinygltf::Value& value)
            { return value.GetNumberAsDouble() == factor.withoutEffect; };
            if (name != std::string("extensions/") + factor.extension + '/' + factor.member ||
                !std::all_of(rest.begin(), rest.end(), isWithoutEffect))
                continue;
            const tinygltf::Value number(factor.withEffect), none(0.0);
            setNumber(material, factor.extension, factor.member,
                      rest.size() == 1 ? number : tinygltf::Value(tinygltf::Value::Array{number, none, none}));
        }
        if (pointer.member->group != "reflection" && name != "extensions/KHR_materials_specular/specularFactor") return;
        const tinygltf::Value& specular = material.extensions["KHR_materials_specular"];
        if (!specular.Has("specularFactor") || specular.Get("specularFactor").GetNumberAsDouble() == 1.0)
            setNumber(material, "KHR_materials_specular", "specularFactor", tinygltf::Value(1.0 - min));
    }

    const std::vector<JsonValue>& objects(Object object) const { return _objects[static_cast<std::size_t>(object)]; }

    tinygltf::Model& _model;
    Report& _report;
    const std::array<std::vector<JsonValue>, 4> _objects; ///< by PropertyMember::Object
    tinygltf::Value::Object _rest;                        ///< by pointer
    tinygltf::Animation* _animation = nullptr;
    std::string _name;    ///< of the channel, for messages
    std::string _pointer; ///< of the channel
    tinygltf::AnimationChannel* _channel = nullptr;
    std::vector<tinygltf::AnimationChannel> _added; ///< for further nodes of a mesh
    /// Of the animation, by node and path, or -1 and pointer: the weights that are taken one by one; -1: all.
    std::map<std::pair<int, std::string>, std::set<int>> _taken;
    std::map<int, std::vector<int>> _nodesOfMesh;
    std::size_t _visitedCount = 0;
};

/// The values at rest of the properties that clips animate, by pointer.
const tinygltf::Value::Object& restOf(const tinygltf::Model& model)
{
    static const tinygltf::Value::Object none;
    const auto rest = model.extensions.find(extensionName);
    return rest == model.extensions.end() ? none : rest->second.Get<tinygltf::Value::Object>();
}

std::vector<float> numbersOf(const tinygltf::Value& array)
{
    std::vector<float> numbers;
    for (const tinygltf::Value& number : array.Get<tinygltf::Value::Array>())
        numbers.push_back(static_cast<float>(number.GetNumberAsDouble()));
    return numbers;
}

} // namespace

void resolvePointers(const JsonValue& document, tinygltf::Model& model, Report& report)
{
    PointerResolver(document, model, report).run();
}

bool hasPointer(const tinygltf::AnimationChannel& channel)
{
    return channel.extensions.count(extensionName) > 0;
}

std::optional<PropertyPointer> propertyOf(const tinygltf::AnimationChannel& channel)
{
    if (channel.target_node >= 0 || !hasPointer(channel)) return std::nullopt;
    return PropertyPointer::parse(channel.target_path);
}

int weightOf(const tinygltf::AnimationChannel& channel)
{
    const auto weight = channel.target_extensions.find(weightName);
    return weight == channel.target_extensions.end() ? -1 : weight->second.GetNumberAsInt();
}

void dropTarget(tinygltf::AnimationChannel& channel)
{
    channel.target_node = -1;
    channel.target_path.clear();
    channel.extensions.clear();
}

std::vector<MorphWeights> propertiesOf(const tinygltf::Model& model)
{
    std::vector<MorphWeights> properties;
    for (const auto& [pointer, numbers] : restOf(model))
        properties.push_back({pointer, -1, numbersOf(numbers)});
    return properties;
}

std::vector<float> valueAtRest(const tinygltf::Model& model, const std::string& pointer)
{
    const auto found = restOf(model).find(pointer);
    return found == restOf(model).end() ? std::vector<float>() : numbersOf(found->second);
}

std::vector<bool> animatedObjects(const tinygltf::Model& model, Object object, std::size_t count)
{
    std::vector<bool> are(count, false);
    for (const auto& [text, numbers] : restOf(model))
    {
        const std::optional<PropertyPointer> pointer = PropertyPointer::parse(text);
        if (pointer && pointer->member->object == object) elementOf(are, pointer->index) = true;
    }
    return are;
}

} // namespace osgGpuAnimation::gltf
