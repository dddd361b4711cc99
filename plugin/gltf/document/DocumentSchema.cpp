// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentRules.h"

#include "gltf/document/SchemaRule.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using namespace schema;

constexpr SchemaRule name = text("name").dropIfInvalid();
constexpr SchemaRule extras = rule("extras", Kind::Any); // of elements whose extras may be read: they can be large

// ------------------------------------------------------------------------------------------- buffers and accessors

constexpr SchemaRule sparseIndices[] = {index("bufferView", "bufferViews").required(),
                                        integer("byteOffset").upTo(maxInt),
                                        code("componentType", "5121 5123 5125").required()};

constexpr SchemaRule sparseValues[] = {index("bufferView", "bufferViews").required(),
                                       integer("byteOffset").upTo(maxInt)};

constexpr SchemaRule sparse[] = {integer("count").from(1).upTo(maxInt).required(),
                                 object("indices", sparseIndices).required(),
                                 object("values", sparseValues).required()};

constexpr SchemaRule accessor[] = {index("bufferView", "bufferViews"),
                                   integer("byteOffset"),
                                   code("componentType", "5120 5121 5122 5123 5125 5126").required(),
                                   rule("normalized", Kind::Boolean),
                                   integer("count").from(1).required(),
                                   choice("type", "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4").required(),
                                   number("min").list(1, 16).dropIfInvalid(),
                                   number("max").list(1, 16).dropIfInvalid(),
                                   object("sparse", sparse),
                                   name};

constexpr SchemaRule fallback[] = {rule("fallback", Kind::Boolean)};
constexpr SchemaRule bufferExtensions[] = {object("EXT_meshopt_compression", fallback),
                                           object("KHR_meshopt_compression", fallback)};

constexpr SchemaRule buffer[] = {text("uri"), integer("byteLength").from(1).required(), name,
                                 object("extensions", bufferExtensions)};

// decompressMeshopt() refuses COLOR, so that a document with uncompressed data beside it is read.
constexpr SchemaRule meshopt[] = {index("buffer", "buffers").required(),
                                  integer("byteOffset"),
                                  integer("byteLength").from(1).required(),
                                  integer("byteStride").from(1).upTo(256).required(),
                                  integer("count").from(1).required(),
                                  choice("mode", "ATTRIBUTES TRIANGLES INDICES").required(),
                                  choice("filter", "NONE OCTAHEDRAL QUATERNION EXPONENTIAL COLOR")};
constexpr SchemaRule bufferViewExtensions[] = {object("EXT_meshopt_compression", meshopt),
                                               object("KHR_meshopt_compression", meshopt)};

constexpr SchemaRule bufferView[] = {
    index("buffer", "buffers").required(),         integer("byteOffset"),
    integer("byteLength").from(1).required(),      integer("byteStride").from(4).upTo(252).inStepsOf(4),
    code("target", "34962 34963").dropIfInvalid(), name,
    object("extensions", bufferViewExtensions)};

// ------------------------------------------------------------------------------------------------------- animations

constexpr SchemaRule pointer[] = {text("pointer").required().dropIfInvalid()};
constexpr SchemaRule targetExtensions[] = {object("KHR_animation_pointer", pointer).dropIfInvalid()};
constexpr SchemaRule target[] = {index("node", "nodes"), text("path").required().dropIfInvalid(),
                                 object("extensions", targetExtensions).dropIfInvalid()};

// checkDocumentRules() compares the index with the samplers of the animation.
constexpr SchemaRule channel[] = {integer("sampler").upTo(maxInt).required(),
                                  object("target", target).required().dropIfInvalid()};

constexpr SchemaRule animationSampler[] = {index("input", "accessors").required(),
                                           choice("interpolation", "LINEAR STEP CUBICSPLINE").dropIfInvalid(),
                                           index("output", "accessors").required()};

constexpr SchemaRule animation[] = {object("channels", channel).list().required().dropIfInvalid(),
                                    object("samplers", animationSampler).list().required().dropIfInvalid(), name,
                                    extras};

// ---------------------------------------------------------------------------------------------- images and materials

constexpr SchemaRule image[] = {text("uri"), text("mimeType").dropIfInvalid(), index("bufferView", "bufferViews"),
                                name};

constexpr SchemaRule sampler[] = {
    code("magFilter", "9728 9729").dropIfInvalid(), code("minFilter", "9728 9729 9984 9985 9986 9987").dropIfInvalid(),
    code("wrapS", "33071 33648 10497").dropIfInvalid(), code("wrapT", "33071 33648 10497").dropIfInvalid(), name};

constexpr SchemaRule otherSource[] = {index("source", "images").dropIfInvalid()};
constexpr SchemaRule otherSources[] = {
    object("EXT_texture_webp", otherSource).dropIfInvalid(), object("KHR_texture_basisu", otherSource).dropIfInvalid(),
    object("MSFT_texture_dds", otherSource).dropIfInvalid(), object("EXT_texture_avif", otherSource).dropIfInvalid()};

constexpr SchemaRule texture[] = {index("sampler", "samplers"), index("source", "images"), name,
                                  object("extensions", otherSources).dropIfInvalid()};

// More sets than any file has; a set is an array slot of OSG's geometries.
constexpr SchemaRule texCoord = integer("texCoord").upTo(31).dropIfInvalid();

constexpr SchemaRule textureTransform[] = {number("offset").list(2, 2).dropIfInvalid(),
                                           number("rotation").dropIfInvalid(),
                                           number("scale").list(2, 2).dropIfInvalid(), texCoord};
constexpr SchemaRule textureExtensions[] = {object("KHR_texture_transform", textureTransform).dropIfInvalid()};

// A fault in a material costs its factor or map alone.
constexpr SchemaRule textureIndex = index("index", "textures").required().dropIfInvalid();
constexpr SchemaRule textureInfoExtensions = object("extensions", textureExtensions).dropIfInvalid();

constexpr SchemaRule textureInfo[] = {textureIndex, texCoord, textureInfoExtensions};
constexpr SchemaRule normalTexture[] = {textureIndex, texCoord, number("scale").dropIfInvalid(), textureInfoExtensions};
constexpr SchemaRule occlusionTexture[] = {textureIndex, texCoord, number("strength").dropIfInvalid().clamped(0, 1),
                                           textureInfoExtensions};
constexpr SchemaRule map(std::string_view name)
{
    return object(name, textureInfo).dropIfInvalid();
}

constexpr SchemaRule metallicRoughness[] = {
    number("baseColorFactor").list(4, 4).dropIfInvalid().clamped(0, 1), map("baseColorTexture"),
    number("metallicFactor").dropIfInvalid().clamped(0, 1), number("roughnessFactor").dropIfInvalid().clamped(0, 1),
    map("metallicRoughnessTexture")};

constexpr SchemaRule emissiveStrength[] = {number("emissiveStrength").from(0).dropIfInvalid()};
constexpr SchemaRule unit(std::string_view name)
{
    return number(name).clamped(0, 1).dropIfInvalid();
}
constexpr SchemaRule ior[] = {number("ior").from(0).dropIfInvalid()};
constexpr SchemaRule specular[] = {unit("specularFactor"), map("specularTexture"),
                                   number("specularColorFactor").list(3, 3).from(0).dropIfInvalid(),
                                   map("specularColorTexture")};
constexpr SchemaRule clearcoat[] = {unit("clearcoatFactor"), map("clearcoatTexture"), unit("clearcoatRoughnessFactor"),
                                    map("clearcoatRoughnessTexture"),
                                    object("clearcoatNormalTexture", normalTexture).dropIfInvalid()};
constexpr SchemaRule sheen[] = {number("sheenColorFactor").list(3, 3).clamped(0, 1).dropIfInvalid(),
                                map("sheenColorTexture"), unit("sheenRoughnessFactor"), map("sheenRoughnessTexture")};
constexpr SchemaRule transmission[] = {unit("transmissionFactor"), map("transmissionTexture")};
constexpr SchemaRule specularGlossiness[] = {number("diffuseFactor").list(4, 4).clamped(0, 1).dropIfInvalid(),
                                             map("diffuseTexture"),
                                             number("specularFactor").list(3, 3).clamped(0, 1).dropIfInvalid(),
                                             unit("glossinessFactor"), map("specularGlossinessTexture")};
constexpr SchemaRule materialExtensions[] = {
    rule("MSFT_lod", Kind::Object).dropIfInvalid(), // not read: validateLods() notes it
    rule("KHR_materials_unlit", Kind::Object).dropIfInvalid(),
    object("KHR_materials_emissive_strength", emissiveStrength).dropIfInvalid(),
    object("KHR_materials_ior", ior).dropIfInvalid(),
    object("KHR_materials_specular", specular).dropIfInvalid(),
    object("KHR_materials_clearcoat", clearcoat).dropIfInvalid(),
    object("KHR_materials_sheen", sheen).dropIfInvalid(),
    object("KHR_materials_transmission", transmission).dropIfInvalid(),
    object("KHR_materials_pbrSpecularGlossiness", specularGlossiness).dropIfInvalid()};

constexpr SchemaRule material[] = {object("pbrMetallicRoughness", metallicRoughness).dropIfInvalid(),
                                   object("normalTexture", normalTexture).dropIfInvalid(),
                                   object("occlusionTexture", occlusionTexture).dropIfInvalid(),
                                   map("emissiveTexture"),
                                   number("emissiveFactor").list(3, 3).dropIfInvalid().clamped(0, 1),
                                   choice("alphaMode", "OPAQUE MASK BLEND").dropIfInvalid(),
                                   number("alphaCutoff").dropIfInvalid().clamped(0, maxFloat),
                                   rule("doubleSided", Kind::Boolean).dropIfInvalid(),
                                   name,
                                   object("extensions", materialExtensions).dropIfInvalid(),
                                   extras};

// --------------------------------------------------------------------------------------------------- meshes and nodes

constexpr SchemaRule draco[] = {index("bufferView", "bufferViews").required(),
                                rule("attributes", Kind::Any).required()};
constexpr SchemaRule mapping[] = {index("material", "materials").required(),
                                  index("variants", "variants").list(0).required()};
constexpr SchemaRule mappings[] = {object("mappings", mapping).list().required().emptyIfInvalid()};
constexpr SchemaRule primitiveExtensions[] = {object("KHR_draco_mesh_compression", draco),
                                              object("KHR_materials_variants", mappings).dropIfInvalid()};

constexpr SchemaRule primitive[] = {indexMap("attributes", "accessors").required(),
                                    index("indices", "accessors"),
                                    index("material", "materials"),
                                    integer("mode").upTo(6),
                                    indexMap("targets", "accessors").list(),
                                    object("extensions", primitiveExtensions)};

constexpr SchemaRule mesh[] = {object("primitives", primitive).list().required(), number("weights").list(), name,
                               extras};

constexpr SchemaRule instancing[] = {indexMap("attributes", "accessors").required()};
constexpr SchemaRule nodeLight[] = {index("light", "lights").required().dropIfInvalid()};
constexpr SchemaRule visibility[] = {rule("visible", Kind::Boolean).dropIfInvalid()};
// validateLods() checks which nodes may be levels.
constexpr SchemaRule lod[] = {index("ids", "nodes").list().required().dropIfInvalid()};
constexpr SchemaRule nodeExtensions[] = {
    object("EXT_mesh_gpu_instancing", instancing), object("KHR_lights_punctual", nodeLight).dropIfInvalid(),
    object("MSFT_lod", lod).dropIfInvalid(), object("KHR_node_visibility", visibility).dropIfInvalid()};

constexpr SchemaRule node[] = {index("camera", "cameras"),
                               index("children", "nodes").list(),
                               index("skin", "skins"),
                               number("matrix").list(16, 16),
                               index("mesh", "meshes"),
                               number("rotation").list(4, 4),
                               number("scale").list(3, 3),
                               number("translation").list(3, 3),
                               number("weights").list(),
                               name,
                               object("extensions", nodeExtensions),
                               extras};

constexpr SchemaRule scene[] = {index("nodes", "nodes").list(), name, extras};

constexpr SchemaRule skin[] = {index("inverseBindMatrices", "accessors"), index("skeleton", "nodes"),
                               index("joints", "nodes").list().required(), name};

// Of cameras, only the size of the view is read.
constexpr SchemaRule perspective[] = {number("yfov").from(aboveZero).upTo(belowPi).required()};
constexpr SchemaRule orthographic[] = {number("ymag").required()};
constexpr SchemaRule camera[] = {choice("type", "perspective orthographic").required(),
                                 object("perspective", perspective), object("orthographic", orthographic), name};

constexpr SchemaRule spot[] = {number("innerConeAngle").from(0).upTo(halfPi),
                               number("outerConeAngle").from(aboveZero).upTo(halfPi)};
constexpr SchemaRule light[] = {choice("type", "directional point spot").required(),
                                number("color").list(3, 3).from(0).withRangeFault(OnFault::Refuse),
                                number("intensity").from(0),
                                number("range").from(aboveZero),
                                object("spot", spot).dropIfInvalid(),
                                name};
constexpr SchemaRule lights[] = {object("lights", light).list().required().emptyIfInvalid()};

constexpr SchemaRule variant[] = {text("name").required()};
constexpr SchemaRule variants[] = {object("variants", variant).list().required().emptyIfInvalid()};

// ------------------------------------------------------------------------------------------------------ the document

constexpr SchemaRule asset[] = {text("version").required(), text("minVersion"), text("generator").dropIfInvalid(),
                                text("copyright").dropIfInvalid()};

constexpr SchemaRule documentExtensions[] = {object("KHR_lights_punctual", lights).dropIfInvalid(),
                                             object("KHR_materials_variants", variants).dropIfInvalid()};

constexpr SchemaRule documentMembers[] = {object("asset", asset).required(),
                                          text("extensionsUsed").list(),
                                          text("extensionsRequired").list(),
                                          object("accessors", accessor).list(),
                                          object("animations", animation).list(),
                                          object("buffers", buffer).list(),
                                          object("bufferViews", bufferView).list(),
                                          object("cameras", camera).list().emptyIfInvalid(),
                                          object("extensions", documentExtensions).dropIfInvalid(),
                                          object("images", image).list(),
                                          object("materials", material).list(),
                                          object("meshes", mesh).list(),
                                          object("nodes", node).list(),
                                          object("samplers", sampler).list(),
                                          index("scene", "scenes"),
                                          object("scenes", scene).list(),
                                          object("skins", skin).list(),
                                          object("textures", texture).list()};

// ----------------------------------------------------------------------------------------------------------- the check

using Type = JsonTree::Type;

std::string rangeText(const SchemaRule& rule)
{
    std::string text = rule.kind == Kind::Integer ? "an integer" : "a number";
    text += rule.min == aboveZero ? " above 0 and up to " : " from " + numberText(rule.min) + " to ";
    text += numberText(rule.max);
    if (rule.step != 1.0) text += " in steps of " + numberText(rule.step);
    return text;
}

std::string elementsText(const SchemaRule& rule)
{
    const std::string what = rule.kind == Kind::Number   ? " numbers"
                             : rule.kind == Kind::Index  ? " indices"
                             : rule.kind == Kind::String ? " texts"
                                                         : " objects";
    return (rule.minCount == rule.maxCount ? "" : "at least ") + std::to_string(rule.minCount) + what;
}

std::string choicesText(const SchemaRule& rule)
{
    const std::string quote = rule.kind == Kind::Choice ? "\"" : "";
    std::string list = "one of " + quote;
    for (const char letter : rule.choices)
        list += letter == ' ' ? quote + ", " + quote : std::string(1, letter);
    return list + quote;
}

bool isChoice(const SchemaRule& rule, const std::string& text)
{
    const bool isWord = text.find(' ') == std::string::npos;
    return isWord && (' ' + std::string(rule.choices) + ' ').find(' ' + text + ' ') != std::string::npos;
}

class SchemaCheck
{
public:
    SchemaCheck(const JsonValue& document, Report& report) : _document(document), _report(report)
    {
        const JsonValue extensions = document["extensions"];
        for (const auto& [extension, member] :
             {std::pair("KHR_lights_punctual", "lights"), {"KHR_materials_variants", "variants"}})
        {
            const JsonValue list = extensions[extension][member];
            _sizes.emplace_back(member, list.is(Type::Array) ? list.size() : 0);
        }
        for (const JsonValue& member : document)
            if (member.is(Type::Array)) _sizes.emplace_back(member.key(), member.size());
    }

    /// The first fault that the document must be refused for.
    std::optional<Error> run()
    {
        if (checkObject(_document, documentMembers, std::size(documentMembers))) return std::nullopt;
        return _finding;
    }

private:
    /// One step of the path to the current value.
    struct Step
    {
        std::string_view member;
        std::size_t index = isMember;
        static constexpr std::size_t isMember = std::size_t(-1);
    };
    enum class Outcome
    {
        Good,
        LeaveOut,
        Refuse
    };

    bool checkObject(const JsonValue& object, const SchemaRule* rules, std::size_t count)
    {
        std::uint64_t seen = 0;
        for (const JsonValue& member : object)
        {
            const SchemaRule* const rule =
                std::find_if(rules, rules + count,
                             [key = member.key()](const SchemaRule& candidate) { return candidate.name == key; });
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

    bool checkMember(const JsonValue& object, const JsonValue& member, const SchemaRule& rule)
    {
        _path.push_back({rule.name});
        const Outcome outcome = rule.isList ? checkList(member, rule) : checkElement(member, rule);
        _path.pop_back();
        if (outcome == Outcome::Good) return true;
        member.dropFrom(object);
        const bool refuse = outcome == Outcome::Refuse || (rule.isRequired && rule.onFault == OnFault::Refuse);
        if (!refuse) _report.warn(_finding.message + "; left out");
        return !refuse;
    }

    bool checkMissing(const SchemaRule& rule)
    {
        _path.push_back({rule.name});
        const char* const expected = rule.isList ? "an array" : rule.kind == Kind::Object ? "an object" : "a value";
        const Outcome outcome = find(rule.onFault, expected, "nothing");
        _path.pop_back();
        if (outcome != Outcome::Refuse) _report.warn(_finding.message);
        return outcome != Outcome::Refuse;
    }

    Outcome checkList(const JsonValue& value, const SchemaRule& rule)
    {
        if (!value.is(Type::Array)) return wrong(rule, "an array of " + elementsText(rule), value);
        if (value.size() == 0 && !rule.isRequired && rule.minCount <= 1)
            return find(OnFault::LeaveOut, elementsText(rule), "none");
        if (value.size() < rule.minCount || value.size() > rule.maxCount) return wrong(rule, elementsText(rule), value);
        _path.push_back({{}, 0});
        Outcome outcome = Outcome::Good;
        for (const JsonValue& element : value)
        {
            outcome = checkElement(element, rule);
            if (outcome != Outcome::Good && rule.onFault == OnFault::Empty)
            {
                _report.warn(_finding.message + "; the element is left out");
                element.dropMembers();
                outcome = Outcome::Good;
            }
            if (outcome != Outcome::Good) break;
            ++_path.back().index;
        }
        _path.pop_back();
        return outcome;
    }

    Outcome checkElement(const JsonValue& value, const SchemaRule& rule)
    {
        switch (rule.kind)
        {
        case Kind::Any:
            return Outcome::Good;
        case Kind::Boolean:
            return value.is(Type::Boolean) ? Outcome::Good : wrong(rule, "true or false", value);
        case Kind::String:
            return value.is(Type::String) ? Outcome::Good : wrong(rule, "a text", value);
        case Kind::Number:
            return checkNumber(value, rule);
        case Kind::Integer:
            return checkInteger(value, rule);
        case Kind::Index:
            return checkIndex(value, rule);
        case Kind::Choice:
        case Kind::Code:
            return checkChoice(value, rule);
        case Kind::IndexMap:
            return checkMap(value, rule);
        case Kind::Object:
            break;
        }
        if (!value.is(Type::Object)) return wrong(rule, "an object", value);
        return checkObject(value, rule.members, rule.memberCount) ? Outcome::Good : Outcome::Refuse;
    }

    Outcome checkNumber(const JsonValue& value, const SchemaRule& rule)
    {
        if (!value.is(Type::Number)) return wrong(rule, "a number", value);
        const double number = value.number();
        if (number >= rule.min && number <= rule.max) return Outcome::Good;
        if (rule.onRange != OnFault::Clamp) return find(rule.onRange, rangeText(rule), value.description());
        const double nearest = std::clamp(number, rule.min, rule.max);
        value.setNumber(nearest);
        // Exporters write 1.0000001: rounding, not a fault.
        if (std::abs(nearest - number) > 1e-5)
            _report.warn(fault(pathText(), rangeText(rule), numberText(number)).message + "; " + numberText(nearest) +
                         " is taken");
        return Outcome::Good;
    }

    Outcome checkInteger(const JsonValue& value, const SchemaRule& rule)
    {
        if (!value.isInteger()) return wrong(rule, "an integer", value);
        const double number = value.number();
        if (number < rule.min || number > rule.max || (rule.step != 1.0 && std::fmod(number, rule.step) != 0.0))
            return find(rule.onRange, rangeText(rule), value.description());
        return Outcome::Good;
    }

    Outcome checkIndex(const JsonValue& value, const SchemaRule& rule)
    {
        const auto found = std::find_if(_sizes.begin(), _sizes.end(),
                                        [&](const auto& entry) { return entry.first == rule.collection; });
        const std::size_t size = found == _sizes.end() ? 0 : found->second;
        if (value.isInteger() && value.number() >= 0.0 && value.number() < static_cast<double>(size))
            return Outcome::Good;
        return wrong(rule, "an index below " + std::to_string(size) + " of " + std::string(rule.collection), value);
    }

    Outcome checkChoice(const JsonValue& value, const SchemaRule& rule)
    {
        const bool isText = rule.kind == Kind::Choice;
        if (value.is(isText ? Type::String : Type::Number))
        {
            const std::string given = isText ? std::string(value.text()) : numberText(value.number());
            if (isChoice(rule, given)) return Outcome::Good;
        }
        return wrong(rule, choicesText(rule), value);
    }

    Outcome checkMap(const JsonValue& value, const SchemaRule& rule)
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

    Outcome wrong(const SchemaRule& rule, const std::string& expected, const JsonValue& found)
    {
        return find(rule.onFault, expected, found.description());
    }

    Outcome find(OnFault policy, const std::string& expected, const std::string& found)
    {
        _finding = fault(pathText(), expected, found);
        return policy == OnFault::Refuse ? Outcome::Refuse : Outcome::LeaveOut;
    }

    std::string pathText() const
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

    JsonValue _document;
    Report& _report;
    /// Of the arrays that indices refer to; those of extensions come first: an array of the document may have any name.
    std::vector<std::pair<std::string_view, std::size_t>> _sizes;
    std::vector<Step> _path;
    Error _finding; ///< the last fault, recorded while its path is known
};

} // namespace

std::optional<Error> checkSchema(const JsonValue& document, Report& report)
{
    return SchemaCheck(document, report).run();
}

} // namespace osgGpuAnimation::gltf
