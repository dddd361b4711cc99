// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentSchema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using namespace schema;

constexpr SchemaRule name = text("name").orLeaveOut();
constexpr SchemaRule extras = any("extras"); // of elements whose extras may be read: they can be large

// ------------------------------------------------------------------------------------------- buffers and accessors

constexpr int componentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr int indexTypes[] = {5121, 5123, 5125};
constexpr int bufferTargets[] = {34962, 34963};
constexpr std::string_view accessorTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};

constexpr SchemaRule sparseIndices[] = {index("bufferView", Collection::BufferViews).required(),
                                        integer("byteOffset").upTo(largestInt),
                                        code("componentType", indexTypes).required()};

constexpr SchemaRule sparseValues[] = {index("bufferView", Collection::BufferViews).required(),
                                       integer("byteOffset").upTo(largestInt)};

constexpr SchemaRule sparse[] = {integer("count").from(1).upTo(largestInt).required(),
                                 object("indices", sparseIndices).required(),
                                 object("values", sparseValues).required()};

constexpr SchemaRule accessor[] = {index("bufferView", Collection::BufferViews),
                                   integer("byteOffset"),
                                   code("componentType", componentTypes).required(),
                                   boolean("normalized"),
                                   integer("count").from(1).required(),
                                   choice("type", accessorTypes).required(),
                                   numbers("min", 1, 16).orLeaveOut(),
                                   numbers("max", 1, 16).orLeaveOut(),
                                   object("sparse", sparse),
                                   name};

constexpr SchemaRule fallback[] = {boolean("fallback")};
constexpr SchemaRule bufferExtensions[] = {object("EXT_meshopt_compression", fallback)};

constexpr SchemaRule buffer[] = {text("uri"), integer("byteLength").from(1).required(), name,
                                 object("extensions", bufferExtensions)};

constexpr std::string_view meshoptModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view meshoptFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
constexpr SchemaRule meshopt[] = {index("buffer", Collection::Buffers).required(),
                                  integer("byteOffset"),
                                  integer("byteLength").from(1).required(),
                                  integer("byteStride").from(1).upTo(256).required(),
                                  integer("count").from(1).required(),
                                  choice("mode", meshoptModes).required(),
                                  choice("filter", meshoptFilters)};
constexpr SchemaRule bufferViewExtensions[] = {object("EXT_meshopt_compression", meshopt)};

constexpr SchemaRule bufferView[] = {
    index("buffer", Collection::Buffers).required(), integer("byteOffset"),
    integer("byteLength").from(1).required(),        integer("byteStride").from(4).upTo(252).inStepsOf(4),
    code("target", bufferTargets).orLeaveOut(),      name,
    object("extensions", bufferViewExtensions)};

// ------------------------------------------------------------------------------------------------------- animations

constexpr std::string_view interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};

constexpr SchemaRule target[] = {index("node", Collection::Nodes), text("path").required().orLeaveOut()};

// Which samplers an animation has, DocumentRules looks up.
constexpr SchemaRule channel[] = {integer("sampler").upTo(largestInt).required(),
                                  object("target", target).required().orLeaveOut()};

constexpr SchemaRule animationSampler[] = {index("input", Collection::Accessors).required(),
                                           choice("interpolation", interpolations).orLeaveOut(),
                                           index("output", Collection::Accessors).required()};

constexpr SchemaRule animation[] = {objects("channels", channel).required().orLeaveOut(),
                                    objects("samplers", animationSampler).required(), name, extras};

// ---------------------------------------------------------------------------------------------- images and materials

constexpr SchemaRule image[] = {text("uri"), text("mimeType").orLeaveOut(),
                                index("bufferView", Collection::BufferViews), name};

constexpr int magFilters[] = {9728, 9729};
constexpr int minFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr int wrapModes[] = {33071, 33648, 10497};
constexpr SchemaRule sampler[] = {code("magFilter", magFilters).orLeaveOut(),
                                  code("minFilter", minFilters).orLeaveOut(), code("wrapS", wrapModes).orLeaveOut(),
                                  code("wrapT", wrapModes).orLeaveOut(), name};

constexpr SchemaRule texture[] = {index("sampler", Collection::Samplers), index("source", Collection::Images), name};

// More sets than any file has; a set is an array slot of OSG's geometries.
constexpr SchemaRule texCoord = integer("texCoord").upTo(31).orLeaveOut();

constexpr SchemaRule textureTransform[] = {numbers("offset", 2).orLeaveOut(), number("rotation").orLeaveOut(),
                                           numbers("scale", 2).orLeaveOut(), texCoord};
constexpr SchemaRule textureExtensions[] = {object("KHR_texture_transform", textureTransform).orLeaveOut()};

constexpr SchemaRule textureIndex = index("index", Collection::Textures).required();
constexpr SchemaRule textureInfoExtensions = object("extensions", textureExtensions).orLeaveOut();

constexpr SchemaRule textureInfo[] = {textureIndex, texCoord, textureInfoExtensions};
constexpr SchemaRule normalTexture[] = {textureIndex, texCoord, number("scale"), textureInfoExtensions};
constexpr SchemaRule occlusionTexture[] = {textureIndex, texCoord, number("strength").clamped(0, 1),
                                           textureInfoExtensions};

constexpr SchemaRule metallicRoughness[] = {
    numbers("baseColorFactor", 4).clamped(0, 1), object("baseColorTexture", textureInfo),
    number("metallicFactor").clamped(0, 1), number("roughnessFactor").clamped(0, 1),
    object("metallicRoughnessTexture", textureInfo)};

constexpr SchemaRule emissiveStrength[] = {number("emissiveStrength").from(0).orLeaveOut()};
constexpr SchemaRule materialExtensions[] = {rule("KHR_materials_unlit", Kind::Object).orLeaveOut(),
                                             object("KHR_materials_emissive_strength", emissiveStrength).orLeaveOut()};

constexpr std::string_view alphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr SchemaRule material[] = {object("pbrMetallicRoughness", metallicRoughness),
                                   object("normalTexture", normalTexture),
                                   object("occlusionTexture", occlusionTexture),
                                   object("emissiveTexture", textureInfo),
                                   numbers("emissiveFactor", 3).clamped(0, 1),
                                   choice("alphaMode", alphaModes).orLeaveOut(),
                                   number("alphaCutoff").clamped(0, largestFloat),
                                   boolean("doubleSided"),
                                   name,
                                   object("extensions", materialExtensions).orLeaveOut(),
                                   extras};

// --------------------------------------------------------------------------------------------------- meshes and nodes

constexpr SchemaRule draco[] = {index("bufferView", Collection::BufferViews).required(), any("attributes").required()};
constexpr SchemaRule primitiveExtensions[] = {object("KHR_draco_mesh_compression", draco)};

constexpr SchemaRule primitive[] = {indexMap("attributes", Collection::Accessors).required(),
                                    index("indices", Collection::Accessors),
                                    index("material", Collection::Materials),
                                    integer("mode").upTo(6),
                                    indexMaps("targets", Collection::Accessors),
                                    object("extensions", primitiveExtensions)};

constexpr SchemaRule mesh[] = {objects("primitives", primitive).required(), numbers("weights", 1, anyCount), name,
                               extras};

constexpr SchemaRule instancing[] = {indexMap("attributes", Collection::Accessors).required()};
constexpr SchemaRule nodeExtensions[] = {object("EXT_mesh_gpu_instancing", instancing)};

constexpr SchemaRule node[] = {index("camera", Collection::Cameras),
                               indices("children", Collection::Nodes),
                               index("skin", Collection::Skins),
                               numbers("matrix", 16),
                               index("mesh", Collection::Meshes),
                               numbers("rotation", 4),
                               numbers("scale", 3),
                               numbers("translation", 3),
                               numbers("weights", 1, anyCount),
                               name,
                               object("extensions", nodeExtensions),
                               extras};

constexpr SchemaRule scene[] = {indices("nodes", Collection::Nodes), name, extras};

constexpr SchemaRule skin[] = {index("inverseBindMatrices", Collection::Accessors),
                               index("skeleton", Collection::Nodes), indices("joints", Collection::Nodes).required(),
                               name};

constexpr std::string_view cameraTypes[] = {"perspective", "orthographic"};
constexpr SchemaRule perspective[] = {number("aspectRatio").from(0), number("yfov").from(0).required(),
                                      number("zfar").from(0), number("znear").from(0).required()};
constexpr SchemaRule orthographic[] = {number("xmag").required(), number("ymag").required(),
                                       number("zfar").from(0).required(), number("znear").from(0).required()};
constexpr SchemaRule camera[] = {choice("type", cameraTypes).required(), object("perspective", perspective),
                                 object("orthographic", orthographic), name};

// ------------------------------------------------------------------------------------------------------ the document

constexpr SchemaRule asset[] = {text("version").required(), text("minVersion"), text("generator").orLeaveOut(),
                                text("copyright").orLeaveOut()};

constexpr SchemaRule documentMembers[] = {object("asset", asset).required(),
                                          texts("extensionsUsed"),
                                          texts("extensionsRequired"),
                                          objects("accessors", accessor),
                                          objects("animations", animation),
                                          objects("buffers", buffer),
                                          objects("bufferViews", bufferView),
                                          objects("cameras", camera),
                                          objects("images", image),
                                          objects("materials", material),
                                          objects("meshes", mesh),
                                          objects("nodes", node),
                                          objects("samplers", sampler),
                                          index("scene", Collection::Scenes),
                                          objects("scenes", scene),
                                          objects("skins", skin),
                                          objects("textures", texture)};

// ----------------------------------------------------------------------------------------------------------- the check

using Type = JsonTree::Type;

/// The member of the document that holds the collection: "accessors", for example.
std::string_view collectionName(Collection collection)
{
    static const std::string_view names[] = {"accessors", "buffers", "bufferViews", "cameras", "images", "materials",
                                             "meshes",    "nodes",   "samplers",    "scenes",  "skins",  "textures"};
    return names[std::size_t(collection)];
}

std::string listed(const SchemaRule& rule)
{
    std::string list = "one of";
    for (std::size_t i = 0; i < rule.choices; ++i)
        list += (i == 0 ? " " : ", ") + (rule.texts ? quoted(rule.texts[i]) : std::to_string(rule.codes[i]));
    return list;
}

std::string rangeText(const SchemaRule& rule, const std::string& what)
{
    std::string text = what + " from " + numberText(rule.least) + " to " + numberText(rule.most);
    if (rule.step != 1.0) text += " in steps of " + numberText(rule.step);
    return text;
}

bool isArrayKind(Kind kind)
{
    return kind == Kind::Numbers || kind == Kind::Indices || kind == Kind::Strings || kind == Kind::Objects ||
           kind == Kind::IndexMaps;
}

std::string elementsText(const SchemaRule& rule)
{
    const std::string what = rule.kind == Kind::Numbers   ? " numbers"
                             : rule.kind == Kind::Indices ? " indices"
                             : rule.kind == Kind::Strings ? " texts"
                                                          : " objects";
    if (rule.leastCount == rule.mostCount) return std::to_string(rule.leastCount) + what;
    return "at least " + std::to_string(rule.leastCount) + what;
}

class SchemaCheck
{
public:
    SchemaCheck(const JsonValue& document, Report& report);

    /// The first fault that the document must be refused for.
    std::optional<Error> run();

private:
    /// One step of the path to the current value.
    struct Step
    {
        std::string_view member;
        std::size_t index = isMember;
        static constexpr std::size_t isMember = std::size_t(-1);
    };
    /// The last fault, recorded while its path is known.
    struct Finding
    {
        std::string element;
        std::string expected;
        std::string found;
    };
    enum class Outcome
    {
        Good,
        LeaveOut,
        Refuse
    };

    bool checkObject(const JsonValue& object, const SchemaRule* rules, std::size_t count);
    bool checkMember(const JsonValue& object, const JsonValue& member, const SchemaRule& rule);
    bool checkMissing(const SchemaRule& rule);
    Outcome checkValue(const JsonValue& value, const SchemaRule& rule);
    Outcome checkNumber(const JsonValue& value, const SchemaRule& rule);
    Outcome checkInteger(const JsonValue& value, const SchemaRule& rule);
    Outcome checkIndex(const JsonValue& value, const SchemaRule& rule);
    Outcome checkChoice(const JsonValue& value, const SchemaRule& rule);
    Outcome checkCode(const JsonValue& value, const SchemaRule& rule);
    Outcome checkMap(const JsonValue& value, const SchemaRule& rule);
    Outcome checkElements(const JsonValue& value, const SchemaRule& rule);
    Outcome checkElement(const JsonValue& value, const SchemaRule& rule);
    Outcome checkType(const JsonValue& value, JsonTree::Type type, const SchemaRule& rule, std::string_view expected);

    Outcome wrong(const SchemaRule& rule, std::string expected, const JsonValue& found);
    Outcome outOfRange(const SchemaRule& rule, std::string expected, const JsonValue& found);
    Outcome find(OnFault policy, std::string expected, std::string found);
    std::string pathText() const;

    JsonValue _document;
    Report& _report;
    std::array<std::size_t, std::size_t(Collection::Count)> _sizes{};
    std::vector<Step> _path;
    Finding _finding;
    std::optional<Error> _error;
};

SchemaCheck::SchemaCheck(const JsonValue& document, Report& report) : _document(document), _report(report)
{
    for (std::size_t i = 0; i < _sizes.size(); ++i)
        if (const JsonValue collection = document[collectionName(Collection(i))])
            if (collection.is(Type::Array)) _sizes[i] = collection.size();
}

std::optional<Error> SchemaCheck::run()
{
    checkObject(_document, documentMembers, std::size(documentMembers));
    return _error;
}

bool SchemaCheck::checkObject(const JsonValue& object, const SchemaRule* rules, std::size_t count)
{
    std::uint64_t seen = 0;
    for (const JsonValue& member : object)
    {
        const SchemaRule* const rule = std::find_if(
            rules, rules + count, [key = member.key()](const SchemaRule& candidate) { return candidate.name == key; });
        if (rule == rules + count)
        {
            member.dropFrom(object);
            continue;
        }
        seen |= std::uint64_t(1) << (rule - rules);
        if (!checkMember(object, member, *rule)) return false;
    }
    for (std::size_t i = 0; i < count; ++i)
        if (rules[i].isRequired && (seen >> i & 1) == 0 && !checkMissing(rules[i])) return false;
    return true;
}

bool SchemaCheck::checkMember(const JsonValue& object, const JsonValue& member, const SchemaRule& rule)
{
    _path.push_back({rule.name});
    const Outcome outcome = checkValue(member, rule);
    _path.pop_back();
    if (outcome == Outcome::Good) return true;
    member.dropFrom(object);
    const Error error = fault(_finding.element, _finding.expected, _finding.found);
    const bool refuse = outcome == Outcome::Refuse || (rule.isRequired && rule.onFault == OnFault::Refuse);
    if (refuse && !_error) _error = error;
    if (!refuse) _report.warn(error.message + "; left out");
    return !refuse;
}

bool SchemaCheck::checkMissing(const SchemaRule& rule)
{
    _path.push_back({rule.name});
    const Outcome outcome = find(rule.onFault,
                                 isArrayKind(rule.kind)      ? "an array"
                                 : rule.kind == Kind::Object ? "an object"
                                                             : "a value",
                                 "nothing");
    _path.pop_back();
    const Error error = fault(_finding.element, _finding.expected, _finding.found);
    if (outcome == Outcome::Refuse)
        _error = error;
    else
        _report.warn(error.message);
    return outcome != Outcome::Refuse;
}

SchemaCheck::Outcome SchemaCheck::checkValue(const JsonValue& value, const SchemaRule& rule)
{
    return isArrayKind(rule.kind) ? checkElements(value, rule) : checkElement(value, rule);
}

SchemaCheck::Outcome SchemaCheck::checkElements(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.is(Type::Array)) return wrong(rule, "an array of " + elementsText(rule), value);
    if (value.size() == 0 && !rule.isRequired && rule.leastCount <= 1)
        return find(OnFault::LeaveOut, elementsText(rule), "none");
    if (value.size() < rule.leastCount || value.size() > rule.mostCount) return wrong(rule, elementsText(rule), value);
    _path.push_back({{}, 0});
    Outcome outcome = Outcome::Good;
    for (const JsonValue& element : value)
    {
        outcome = checkElement(element, rule);
        if (outcome != Outcome::Good) break;
        ++_path.back().index;
    }
    _path.pop_back();
    return outcome;
}

SchemaCheck::Outcome SchemaCheck::checkElement(const JsonValue& value, const SchemaRule& rule)
{
    switch (rule.kind)
    {
    case Kind::Any:
        return Outcome::Good;
    case Kind::Boolean:
        return checkType(value, Type::Boolean, rule, "true or false");
    case Kind::String:
    case Kind::Strings:
        return checkType(value, Type::String, rule, "a text");
    case Kind::Number:
    case Kind::Numbers:
        return checkNumber(value, rule);
    case Kind::Integer:
        return checkInteger(value, rule);
    case Kind::Index:
    case Kind::Indices:
        return checkIndex(value, rule);
    case Kind::Choice:
        return checkChoice(value, rule);
    case Kind::Code:
        return checkCode(value, rule);
    case Kind::IndexMap:
    case Kind::IndexMaps:
        return checkMap(value, rule);
    case Kind::Object:
    case Kind::Objects:
        break;
    }
    const Outcome outcome = checkType(value, Type::Object, rule, "an object");
    if (outcome != Outcome::Good) return outcome;
    return checkObject(value, rule.members, rule.memberCount) ? Outcome::Good : Outcome::Refuse;
}

SchemaCheck::Outcome SchemaCheck::checkType(const JsonValue& value, Type type, const SchemaRule& rule,
                                            std::string_view expected)
{
    return value.is(type) ? Outcome::Good : wrong(rule, std::string(expected), value);
}

SchemaCheck::Outcome SchemaCheck::checkNumber(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.is(Type::Number)) return wrong(rule, "a number", value);
    const double number = value.number();
    if (number >= rule.least && number <= rule.most) return Outcome::Good;
    if (rule.onRange != OnFault::Clamp) return outOfRange(rule, rangeText(rule, "a number"), value);
    const double nearest = std::clamp(number, rule.least, rule.most);
    value.setNumber(nearest);
    // Exporters write 1.0000001: rounding, not a fault.
    if (std::abs(nearest - number) > 1e-5)
        _report.warn(fault(pathText(), rangeText(rule, "a number"), numberText(number)).message + "; " +
                     numberText(nearest) + " is taken");
    return Outcome::Good;
}

SchemaCheck::Outcome SchemaCheck::checkInteger(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.isInteger()) return wrong(rule, "an integer", value);
    const double number = value.number();
    if (number < rule.least || number > rule.most || (rule.step != 1.0 && std::fmod(number, rule.step) != 0.0))
        return outOfRange(rule, rangeText(rule, "an integer"), value);
    return Outcome::Good;
}

SchemaCheck::Outcome SchemaCheck::checkIndex(const JsonValue& value, const SchemaRule& rule)
{
    const std::size_t size = _sizes[std::size_t(rule.refersTo)];
    if (value.isInteger() && value.number() >= 0.0 && value.number() < double(size)) return Outcome::Good;
    return wrong(rule, "an index below " + std::to_string(size) + " of " + std::string(collectionName(rule.refersTo)),
                 value);
}

SchemaCheck::Outcome SchemaCheck::checkChoice(const JsonValue& value, const SchemaRule& rule)
{
    if (value.is(Type::String))
        for (std::size_t i = 0; i < rule.choices; ++i)
            if (value.text() == rule.texts[i]) return Outcome::Good;
    return wrong(rule, listed(rule), value);
}

SchemaCheck::Outcome SchemaCheck::checkCode(const JsonValue& value, const SchemaRule& rule)
{
    if (value.is(Type::Number))
        for (std::size_t i = 0; i < rule.choices; ++i)
            if (value.number() == rule.codes[i]) return Outcome::Good;
    return wrong(rule, listed(rule), value);
}

SchemaCheck::Outcome SchemaCheck::checkMap(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.is(Type::Object)) return wrong(rule, "an object of indices", value);
    for (const JsonValue& member : value)
    {
        _path.push_back({member.key()});
        const Outcome outcome = checkIndex(member, rule);
        _path.pop_back();
        if (outcome != Outcome::Good) return outcome;
    }
    return Outcome::Good;
}

SchemaCheck::Outcome SchemaCheck::wrong(const SchemaRule& rule, std::string expected, const JsonValue& found)
{
    return find(rule.onFault, std::move(expected), found.description());
}

SchemaCheck::Outcome SchemaCheck::outOfRange(const SchemaRule& rule, std::string expected, const JsonValue& found)
{
    return find(rule.onRange, std::move(expected), found.description());
}

SchemaCheck::Outcome SchemaCheck::find(OnFault policy, std::string expected, std::string found)
{
    _finding = {pathText(), std::move(expected), std::move(found)};
    return policy == OnFault::Refuse ? Outcome::Refuse : Outcome::LeaveOut;
}

std::string SchemaCheck::pathText() const
{
    std::string text;
    for (const Step& step : _path)
    {
        if (step.index != Step::isMember)
            text = elementName(text, step.index);
        else
            text += (text.empty() ? "" : ".") + printable(step.member);
    }
    return text;
}

} // namespace

std::optional<Error> checkSchema(const JsonValue& document, Report& report)
{
    return SchemaCheck(document, report).run();
}

} // namespace osgGpuAnimation::gltf
