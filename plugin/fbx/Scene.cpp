// SPDX-License-Identifier: MIT
#include "fbx/Scene.h"

#include "gltf/file/Report.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace osgGpuAnimation::fbx
{

namespace
{

constexpr double ticksPerSecond = 46186158000.0, ticksPerSecondOfVersion8 = 141120000.0;
constexpr int originalTimeDefinition = 127;

/// A property that takes animate.
struct MovingProperty
{
    std::string_view name;
    AnimatedVector ModelTracks::*track;
    glm::dvec3 Model::*rest;
};

constexpr MovingProperty movingProperties[] = {{"Lcl Translation", &ModelTracks::translation, &Model::translation},
                                               {"Lcl Rotation", &ModelTracks::rotation, &Model::rotation},
                                               {"Lcl Scaling", &ModelTracks::scale, &Model::scale}};
constexpr std::string_view componentNames[3] = {"d|X", "d|Y", "d|Z"};

/// An object of the file: `Model: 1001, "Model::door", "Mesh"`.
struct Object
{
    const Element* element;
    std::string_view kind;
    std::string_view name; ///< without its class
    std::string_view type;
};

struct Connection
{
    std::int64_t other; ///< the source or the destination
    std::string_view property;
};

/// Names of which each occurs once, and where the search for further ones continues.
struct TakenNames
{
    std::set<std::string, std::less<>> names;
    /// The next number by the characters before it and its number of digits.
    std::map<std::pair<std::string, std::size_t>, std::size_t> nextNumbers;
};

/// A name of the same length that is not taken yet: the name itself, or with a number in place of its last characters.
/// None: all are taken. Each number is tried once, however many names there are.
std::optional<std::string> takeName(const std::string& name, TakenNames& taken)
{
    if (taken.names.insert(name).second) return name;
    constexpr std::string_view digits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    constexpr std::size_t maxDigits = 8;
    std::size_t first = 0, end = digits.size(); // the numbers of that many digits
    for (std::size_t count = 1; count <= std::min(maxDigits, name.size()); ++count, first = end, end *= digits.size())
    {
        const std::string before = name.substr(0, name.size() - count);
        std::size_t& next = taken.nextNumbers.try_emplace({before, count}, first).first->second;
        while (next < end)
        {
            std::string made = name;
            std::size_t rest = next++;
            for (std::size_t place = name.size(); place > before.size(); --place, rest /= digits.size())
                made[place - 1] = digits[rest % digits.size()];
            if (taken.names.insert(made).second) return made;
        }
    }
    return std::nullopt;
}

class SceneReader
{
public:
    SceneReader(Scene& scene, const std::string& bytes, const Document& document)
        : _scene(scene), _bytes(bytes), _document(document)
    {
    }

    void read()
    {
        readSettings();
        readObjects();
        readConnections();
        readModels();
        readShapes();
        readSkins();
        readTakes();
    }

private:
    void readSettings();
    void readObjects();
    void readConnections();
    void readModels();
    void readShapes();
    void readSkins();
    void addBinding(std::int64_t cluster, const Element& element, Model& model);
    void readTakes();
    void readTake(std::int64_t id, const Object& stack);
    void readCurveNode(std::int64_t id, std::int64_t layer, Take& take);
    void warnOfLost(std::int64_t curveNode, std::string_view name, const Model& model, const Take& take);
    void addCurves(std::int64_t curveNode, std::int64_t layerId, AnimatedVector& vector);
    void setRange(const Element& stack, Take& take);

    const Object* object(std::int64_t id) const
    {
        const auto found = _objects.find(id);
        return found == _objects.end() ? nullptr : &found->second;
    }
    const std::vector<Connection>& sources(std::int64_t destination) { return _sources[destination]; }
    const std::vector<Connection>& destinations(std::int64_t source) { return _destinations[source]; }
    /// The curve of a connection; null: it has none.
    const Element* curveOf(const Connection& source) const
    {
        const Object* const found = object(source.other);
        return found && found->kind == "AnimationCurve" ? found->element : nullptr;
    }
    /// The values of a property after its name, type, label and flags.
    static const Element* property(const Element& element, std::string_view name);
    static double number(const Element& element, std::string_view name, double without);
    static glm::dvec3 vector(const Element& element, std::string_view name,
                             const glm::dvec3& without = glm::dvec3(0.0));
    std::int64_t idOf(const Element& element) const { return element.values[0].integer; }

    void patch(std::string_view view, std::string_view with)
    {
        _scene.bytesForAssimp.replace(static_cast<std::size_t>(view.data() - _bytes.data()), with.size(), with);
    }
    /// taken: takes it, too.
    std::string uniqueName(std::string_view name, TakenNames& taken, bool withoutPoints = false);

    Scene& _scene;
    const std::string& _bytes; ///< of which the document has views
    const Document& _document;
    double _ticksPerSecond = ticksPerSecond;
    std::vector<std::int64_t> _order; ///< ids as the file has them
    std::vector<std::int64_t> _modelIds;
    std::unordered_map<std::int64_t, Object> _objects;
    std::unordered_map<std::int64_t, std::vector<Connection>> _sources, _destinations; ///< in the order of the file
    std::unordered_map<std::int64_t, std::size_t> _models, _channels;                  ///< their numbers by id
    std::set<std::pair<std::size_t, std::string_view>> _withoutRest;                   ///< models and their properties
};

const Element* SceneReader::property(const Element& element, std::string_view name)
{
    const Element* const all = element.child("Properties70");
    if (!all) return nullptr;
    for (const Element& each : all->children)
        if (each.name == "P" && each.values.size() > 4 && each.values[0].text == name) return &each;
    return nullptr;
}

double SceneReader::number(const Element& element, std::string_view name, double without)
{
    const Element* const found = property(element, name);
    return found && std::isfinite(found->values[4].number) ? found->values[4].number : without;
}

glm::dvec3 SceneReader::vector(const Element& element, std::string_view name, const glm::dvec3& without)
{
    const Element* const found = property(element, name);
    if (!found || found->values.size() < 7) return without;
    const glm::dvec3 read(found->values[4].number, found->values[5].number, found->values[6].number);
    return std::isfinite(read.x + read.y + read.z) ? read : without;
}

void SceneReader::readSettings()
{
    if (const Element* const settings = _document.root.child("GlobalSettings"))
        _scene.metresPerUnit = 0.01 * number(*settings, "UnitScaleFactor", 1.0);
    if (_document.version >= 8000) _ticksPerSecond = ticksPerSecondOfVersion8;
    const Element* const header = _document.root.child("FBXHeaderExtension");
    const Element* const flags = header ? header->child("OtherFlags") : nullptr;
    const Element* const definition = flags ? flags->child("TCDefinition") : nullptr;
    if (definition && !definition->values.empty())
        _ticksPerSecond =
            definition->values[0].integer == originalTimeDefinition ? ticksPerSecond : ticksPerSecondOfVersion8;
}

void SceneReader::readObjects()
{
    const Element* const all = _document.root.child("Objects");
    if (!all) return;
    for (const Element& element : all->children)
    {
        if (element.values.size() < 3 || element.values[0].isText) continue;
        std::string_view name = element.values[1].text;
        if (const std::size_t end = name.find(std::string_view("\0\1", 2)); end != std::string_view::npos)
            name = name.substr(0, end); // binary: NAME, 0, 1, CLASS
        else if (const std::size_t colons = name.find("::"); colons != std::string_view::npos)
            name = name.substr(colons + 2); // ASCII: CLASS::NAME
        const std::int64_t id = idOf(element);
        if (_objects.emplace(id, Object{&element, element.name, name, element.values[2].text}).second)
            _order.push_back(id);
        if (element.name == "AnimationStack") patch(element.name.substr(element.name.size() - 1), "X");
        if (element.name != "Model") continue;
        const Element* const properties = element.child("Properties70");
        if (!properties) continue;
        for (const Element& each : properties->children)
            if (each.values.size() > 1 && each.values[1].text == "KTime") patch(each.values[1].text, "XTime");
    }
}

void SceneReader::readConnections()
{
    const Element* const all = _document.root.child("Connections");
    if (!all) return;
    for (const Element& each : all->children)
    {
        if (each.values.size() < 3 || each.values[1].isText || each.values[2].isText) continue;
        const std::string_view name = each.values.size() > 3 ? each.values[3].text : std::string_view();
        _sources[each.values[2].integer].push_back({each.values[1].integer, name});
        _destinations[each.values[1].integer].push_back({each.values[2].integer, name});
    }
}

std::string SceneReader::uniqueName(std::string_view name, TakenNames& taken, bool withoutPoints)
{
    std::string wanted(name);
    if (withoutPoints) std::replace(wanted.begin(), wanted.end(), '.', '_');
    const std::optional<std::string> made = takeName(wanted, taken);
    if (!made)
    {
        _scene.warnings.push_back("several nodes or shapes have the name " + gltf::quoted(name) +
                                  ": they are taken as one; longer names tell them apart");
        return std::string(name);
    }
    if (*made != name) patch(name, *made);
    return *made;
}

void SceneReader::readModels()
{
    TakenNames taken{{"RootNode"}, {}}; // Assimp's own
    for (const std::int64_t id : _order)
    {
        const Object& each = *object(id);
        if (each.kind != "Model" || each.type == "IKEffector" || each.type == "FKEffector") continue;
        const Element& element = *each.element;
        Model model;
        model.name = each.name;
        model.uniqueName = uniqueName(each.name, taken);
        for (const MovingProperty& property : movingProperties)
            model.*property.rest = vector(element, property.name, model.*property.rest);
        model.rotationOrder = static_cast<int>(std::clamp(number(element, "RotationOrder", 0.0), 0.0, 6.0));
        if (model.rotationOrder == 6)
            _scene.warnings.push_back("node " + gltf::quoted(model.name) +
                                      ": its rotation order is spheric; read as XYZ");
        model.rotationOffset = vector(element, "RotationOffset");
        model.rotationPivot = vector(element, "RotationPivot");
        model.scalingOffset = vector(element, "ScalingOffset");
        model.scalingPivot = vector(element, "ScalingPivot");
        model.preRotation = vector(element, "PreRotation");
        model.postRotation = vector(element, "PostRotation");
        constexpr double withoutParentScale = 2.0;
        model.compensatesScale = number(element, "InheritType", 1.0) == withoutParentScale;
        model.isHidden = number(element, "Visibility", 1.0) <= 0.0;
        const glm::dmat4 one(1.0);
        model.geometric = glm::translate(one, vector(element, "GeometricTranslation")) *
                          glm::mat4_cast(rotationOf(vector(element, "GeometricRotation"), 0)) *
                          glm::scale(one, vector(element, "GeometricScaling", glm::dvec3(1.0)));
        _models.emplace(id, _scene.models.size());
        _modelIds.push_back(id);
        _scene.models.push_back(std::move(model));
    }
    for (std::size_t i = 0; i < _modelIds.size(); ++i)
    {
        Model& model = _scene.models[i];
        for (const Connection& each : destinations(_modelIds[i]))
            if (const auto parent = _models.find(each.other); parent != _models.end() && each.property.empty())
                model.parent = static_cast<int>(parent->second);
        // InheritType 0, the scale of the parent along the axes of the model, is a matrix that shears where that scale
        // has axes.
        if (model.parent < 0 || number(*object(_modelIds[i])->element, "InheritType", 1.0) != 0.0) continue;
        const glm::dvec3& above = _scene.models[static_cast<std::size_t>(model.parent)].scale;
        if (above.x != above.y || above.y != above.z)
            _scene.warnings.push_back("node " + gltf::quoted(model.name) +
                                      ": expected InheritType 1 or 2 below a parent that is scaled by axes, found 0; "
                                      "read as 1: give the parent one scale for all axes");
    }
}

void SceneReader::readShapes()
{
    TakenNames taken, takenTargets;
    for (const std::int64_t id : _order)
    {
        const Object& each = *object(id);
        if (each.kind != "Deformer" || each.type != "BlendShapeChannel") continue;
        ShapeChannel channel;
        channel.name = each.name;
        channel.uniqueName = uniqueName(each.name, taken, true);
        const Element* const direct = each.element->child("DeformPercent");
        channel.percent =
            number(*each.element, "DeformPercent", direct && !direct->values.empty() ? direct->values[0].number : 0.0);
        if (!std::isfinite(channel.percent)) channel.percent = 0.0;
        for (const Connection& source : sources(id))
            if (const Object* const shape = object(source.other); shape && shape->kind == "Geometry")
                channel.targetNames.push_back(uniqueName(shape->name, takenTargets));
        channel.fullPercents = each.element->numbers("FullWeights");
        _channels.emplace(id, _scene.channels.size());
        _scene.channels.push_back(std::move(channel));
    }
    for (const auto& [modelId, model] : _models)
        for (const Connection& geometry : sources(modelId))
        {
            const Object* const mesh = object(geometry.other);
            if (!mesh || mesh->kind != "Geometry" || !_scene.models[model].shapes.empty()) continue;
            for (const Connection& deformer : sources(geometry.other))
                for (const Connection& source : sources(deformer.other))
                    if (const auto channel = _channels.find(source.other); channel != _channels.end())
                        _scene.models[model].shapes.insert(_scene.models[model].shapes.end(),
                                                           _scene.channels[channel->second].targets(), channel->second);
        }
}

void SceneReader::readSkins()
{
    for (std::size_t model = 0; model < _modelIds.size(); ++model)
        for (const Connection& geometry : sources(_modelIds[model]))
            for (const Connection& skin : sources(geometry.other))
                for (const Connection& cluster : sources(skin.other))
                    if (const Object* const found = object(cluster.other); found && found->type == "Cluster")
                        addBinding(cluster.other, *found->element, _scene.models[model]);
}

void SceneReader::addBinding(std::int64_t cluster, const Element& element, Model& model)
{
    const std::vector<double> numbers = element.numbers("Transform"); // of row vectors, row by row
    if (numbers.size() != 16) return;
    Binding binding{0, glm::dmat4(1.0)};
    for (std::size_t i = 0; i < 16; ++i)
        binding.meshToBone[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = numbers[i];
    for (const Connection& bone : sources(cluster))
        if (const auto found = _models.find(bone.other); found != _models.end())
        {
            binding.bone = found->second;
            model.bindings.push_back(binding);
        }
}

void SceneReader::readTakes()
{
    std::string constraint;
    std::size_t constraints = 0;
    for (const std::int64_t id : _order)
    {
        const Object& each = *object(id);
        if (each.kind == "AnimationStack") readTake(id, each);
        if (each.kind == "Constraint" && constraints++ == 0) constraint = each.name;
    }
    if (constraints > 0)
        _scene.warnings.push_back(std::to_string(constraints) + " constraints, the first of them " +
                                  gltf::quoted(constraint) + ", move nothing: bake the animation when you export");
}

void SceneReader::readTake(std::int64_t id, const Object& stack)
{
    Take take;
    take.name = stack.name;
    for (const Connection& layer : sources(id))
    {
        const Object* const found = object(layer.other);
        if (!found || found->kind != "AnimationLayer") continue;
        for (const Connection& node : sources(layer.other))
            if (node.property == "Weight")
                _scene.warnings.push_back("take " + gltf::quoted(take.name) +
                                          ": it animates the weight of a layer, which stays as it is at rest: merge "
                                          "the layers when you export");
            else if (const Object* const curves = object(node.other); curves && curves->kind == "AnimationCurveNode")
                readCurveNode(node.other, layer.other, take);
    }
    setRange(*stack.element, take);
    // A property that the model lacks rests where its first take begins, as Maya's export of game animations means it.
    for (const auto& [model, tracks] : take.models)
        for (const MovingProperty& each : movingProperties)
            if (!(tracks.*each.track).layers.empty() && !property(*object(_modelIds[model])->element, each.name) &&
                _withoutRest.emplace(model, each.name).second)
                _scene.models[model].*each.rest = (tracks.*each.track).at(take.begin);
    _scene.takes.push_back(std::move(take));
}

void SceneReader::readCurveNode(std::int64_t id, std::int64_t layer, Take& take)
{
    for (const Connection& target : destinations(id))
    {
        if (const auto channel = _channels.find(target.other); channel != _channels.end())
        {
            for (const Connection& source : sources(id))
                if (const Element* const curve = curveOf(source))
                    if (Curve read = Curve::of(*curve, _ticksPerSecond); !read.isEmpty())
                        take.shapes.push_back({channel->second, std::move(read)});
            continue;
        }
        const auto found = _models.find(target.other);
        if (found == _models.end()) continue;
        const Model& model = _scene.models[found->second];
        const auto part = std::find_if(std::begin(movingProperties), std::end(movingProperties),
                                       [&](const MovingProperty& each) { return each.name == target.property; });
        if (part == std::end(movingProperties))
        {
            warnOfLost(id, target.property, model, take);
            continue;
        }
        const ModelTracks atRest{{model.translation, false, {}}, {model.rotation, false, {}}, {model.scale, true, {}}};
        addCurves(id, layer, take.models.emplace(found->second, atRest).first->second.*part->track);
    }
}

/// Curves of what a clip cannot move.
void SceneReader::warnOfLost(std::int64_t curveNode, std::string_view name, const Model& model, const Take& take)
{
    constexpr std::string_view lost[] = {"Visibility",       "RotationOffset",       "RotationPivot",
                                         "ScalingOffset",    "ScalingPivot",         "PreRotation",
                                         "PostRotation",     "GeometricTranslation", "GeometricRotation",
                                         "GeometricScaling", "RotationOrder",        "InheritType"};
    if (std::find(std::begin(lost), std::end(lost), name) == std::end(lost)) return;
    std::vector<double> values;
    for (const Connection& source : sources(curveNode))
        if (const Element* const curve = curveOf(source))
            for (const double value : curve->numbers("KeyValueFloat"))
                values.push_back(name == "Visibility" ? static_cast<double>(value > 0.0) : value);
    const bool isStill = name == "Visibility"
                             ? std::count(values.begin(), values.end(), model.isHidden ? 1.0 : 0.0) == 0
                             : values.empty();
    if (isStill) return;
    _scene.warnings.push_back("take " + gltf::quoted(take.name) + ": it animates " + std::string(name) + " of node " +
                              gltf::quoted(model.name) + ", which no clip can: it stays as it is at rest");
}

void SceneReader::addCurves(std::int64_t curveNode, std::int64_t layerId, AnimatedVector& vector)
{
    AnimatedVector::Layer layer;
    bool hasCurve = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const Connection& source : sources(curveNode))
            if (const Object* const curve = object(source.other); curve && source.property == componentNames[axis])
                if (Curve read = Curve::of(*curve->element, _ticksPerSecond); !read.isEmpty())
                {
                    layer.curves[axis] = std::move(read);
                    hasCurve = true;
                }
    if (!hasCurve) return;
    const Element& settings = *object(layerId)->element;
    layer.weight = std::clamp(number(settings, "Weight", 100.0) / 100.0, 0.0, 1.0);
    layer.isOverride = vector.layers.empty() || number(settings, "BlendMode", 0.0) != 0.0;
    if (layer.isOverride)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const Element* const constant = property(*object(curveNode)->element, componentNames[axis]))
                if (std::isfinite(constant->values[4].number)) layer.constants[axis] = constant->values[4].number;
    vector.layers.push_back(std::move(layer));
}

void SceneReader::setRange(const Element& stack, Take& take)
{
    take.begin = number(stack, "LocalStart", 0.0) / _ticksPerSecond;
    take.end = number(stack, "LocalStop", 0.0) / _ticksPerSecond;
    if (take.end > take.begin) return;
    std::vector<double> times;
    for (const auto& [model, tracks] : take.models)
        for (const MovingProperty& each : movingProperties)
            (tracks.*each.track).appendTimes(times);
    for (const ShapeTrack& each : take.shapes)
        each.percent.appendTimes(times);
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    take.begin = times.empty() ? 0.0 : *first;
    take.end = times.empty() ? 0.0 : *last;
}

} // namespace

Result<Scene> Scene::read(std::string bytes)
{
    const Result<Document> document = Document::parse(bytes);
    if (!document) return document.error();
    if (document.value().version < 7000)
        return Error{"it has FBX version " + std::to_string(document.value().version) +
                     "; expected 7000 or later: write it again as FBX 2011 or later"};
    Scene scene;
    scene.bytesForAssimp = bytes;
    SceneReader(scene, bytes, document.value()).read();
    return scene;
}

} // namespace osgGpuAnimation::fbx
