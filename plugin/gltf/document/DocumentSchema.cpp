// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentSchema.h"

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

constexpr SchemaRule name = text("name").orLeaveOut();
constexpr SchemaRule extras = rule("extras", Kind::Any); // of elements whose extras may be read: they can be large

// ------------------------------------------------------------------------------------------- buffers and accessors

constexpr SchemaRule sparseIndices[] = {index("bufferView", "bufferViews").required(),
                                        integer("byteOffset").upTo(largestInt),
                                        code("componentType", "5121 5123 5125").required()};

constexpr SchemaRule sparseValues[] = {index("bufferView", "bufferViews").required(),
                                       integer("byteOffset").upTo(largestInt)};

constexpr SchemaRule sparse[] = {integer("count").from(1).upTo(largestInt).required(),
                                 object("indices", sparseIndices).required(),
                                 object("values", sparseValues).required()};

constexpr SchemaRule accessor[] = {index("bufferView", "bufferViews"),
                                   integer("byteOffset"),
                                   code("componentType", "5120 5121 5122 5123 5125 5126").required(),
                                   rule("normalized", Kind::Boolean),
                                   integer("count").from(1).required(),
                                   choice("type", "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4").required(),
                                   number("min").list(1, 16).orLeaveOut(),
                                   number("max").list(1, 16).orLeaveOut(),
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
    index("buffer", "buffers").required(),      integer("byteOffset"),
    integer("byteLength").from(1).required(),   integer("byteStride").from(4).upTo(252).inStepsOf(4),
    code("target", "34962 34963").orLeaveOut(), name,
    object("extensions", bufferViewExtensions)};

// ------------------------------------------------------------------------------------------------------- animations

constexpr SchemaRule pointer[] = {text("pointer").required().orLeaveOut()};
constexpr SchemaRule targetExtensions[] = {object("KHR_animation_pointer", pointer).orLeaveOut()};
constexpr SchemaRule target[] = {index("node", "nodes"), text("path").required().orLeaveOut(),
                                 object("extensions", targetExtensions).orLeaveOut()};

// checkDocumentRules() compares the index with the samplers of the animation.
constexpr SchemaRule channel[] = {integer("sampler").upTo(largestInt).required(),
                                  object("target", target).required().orLeaveOut()};

constexpr SchemaRule animationSampler[] = {index("input", "accessors").required(),
                                           choice("interpolation", "LINEAR STEP CUBICSPLINE").orLeaveOut(),
                                           index("output", "accessors").required()};

constexpr SchemaRule animation[] = {object("channels", channel).list().required().orLeaveOut(),
                                    object("samplers", animationSampler).list().required(), name, extras};

// ---------------------------------------------------------------------------------------------- images and materials

constexpr SchemaRule image[] = {text("uri"), text("mimeType").orLeaveOut(), index("bufferView", "bufferViews"), name};

constexpr SchemaRule sampler[] = {
    code("magFilter", "9728 9729").orLeaveOut(), code("minFilter", "9728 9729 9984 9985 9986 9987").orLeaveOut(),
    code("wrapS", "33071 33648 10497").orLeaveOut(), code("wrapT", "33071 33648 10497").orLeaveOut(), name};

constexpr SchemaRule otherSource[] = {index("source", "images").orLeaveOut()};
constexpr SchemaRule otherSources[] = {
    object("EXT_texture_webp", otherSource).orLeaveOut(), object("KHR_texture_basisu", otherSource).orLeaveOut(),
    object("MSFT_texture_dds", otherSource).orLeaveOut(), object("EXT_texture_avif", otherSource).orLeaveOut()};

constexpr SchemaRule texture[] = {index("sampler", "samplers"), index("source", "images"), name,
                                  object("extensions", otherSources).orLeaveOut()};

// More sets than any file has; a set is an array slot of OSG's geometries.
constexpr SchemaRule texCoord = integer("texCoord").upTo(31).orLeaveOut();

constexpr SchemaRule textureTransform[] = {number("offset").list(2, 2).orLeaveOut(), number("rotation").orLeaveOut(),
                                           number("scale").list(2, 2).orLeaveOut(), texCoord};
constexpr SchemaRule textureExtensions[] = {object("KHR_texture_transform", textureTransform).orLeaveOut()};

// A fault in a material costs its factor or map alone.
constexpr SchemaRule textureIndex = index("index", "textures").required().orLeaveOut();
constexpr SchemaRule textureInfoExtensions = object("extensions", textureExtensions).orLeaveOut();

constexpr SchemaRule textureInfo[] = {textureIndex, texCoord, textureInfoExtensions};
constexpr SchemaRule normalTexture[] = {textureIndex, texCoord, number("scale").orLeaveOut(), textureInfoExtensions};
constexpr SchemaRule occlusionTexture[] = {textureIndex, texCoord, number("strength").orLeaveOut().clamped(0, 1),
                                           textureInfoExtensions};
constexpr SchemaRule map(std::string_view name)
{
    return object(name, textureInfo).orLeaveOut();
}

constexpr SchemaRule metallicRoughness[] = {
    number("baseColorFactor").list(4, 4).orLeaveOut().clamped(0, 1), map("baseColorTexture"),
    number("metallicFactor").orLeaveOut().clamped(0, 1), number("roughnessFactor").orLeaveOut().clamped(0, 1),
    map("metallicRoughnessTexture")};

constexpr SchemaRule emissiveStrength[] = {number("emissiveStrength").from(0).orLeaveOut()};
constexpr SchemaRule unit(std::string_view name)
{
    return number(name).clamped(0, 1).orLeaveOut();
}
constexpr SchemaRule ior[] = {number("ior").from(0).orLeaveOut()};
constexpr SchemaRule specular[] = {unit("specularFactor"), map("specularTexture"),
                                   number("specularColorFactor").list(3, 3).from(0).orLeaveOut(),
                                   map("specularColorTexture")};
constexpr SchemaRule clearcoat[] = {unit("clearcoatFactor"), map("clearcoatTexture"), unit("clearcoatRoughnessFactor"),
                                    map("clearcoatRoughnessTexture"),
                                    object("clearcoatNormalTexture", normalTexture).orLeaveOut()};
constexpr SchemaRule sheen[] = {number("sheenColorFactor").list(3, 3).clamped(0, 1).orLeaveOut(),
                                map("sheenColorTexture"), unit("sheenRoughnessFactor"), map("sheenRoughnessTexture")};
constexpr SchemaRule transmission[] = {unit("transmissionFactor"), map("transmissionTexture")};
constexpr SchemaRule specularGlossiness[] = {number("diffuseFactor").list(4, 4).clamped(0, 1).orLeaveOut(),
                                             map("diffuseTexture"),
                                             number("specularFactor").list(3, 3).clamped(0, 1).orLeaveOut(),
                                             unit("glossinessFactor"), map("specularGlossinessTexture")};
constexpr SchemaRule materialExtensions[] = {
    rule("MSFT_lod", Kind::Object).orLeaveOut(), // not read: validateLods() notes it
    rule("KHR_materials_unlit", Kind::Object).orLeaveOut(),
    object("KHR_materials_emissive_strength", emissiveStrength).orLeaveOut(),
    object("KHR_materials_ior", ior).orLeaveOut(),
    object("KHR_materials_specular", specular).orLeaveOut(),
    object("KHR_materials_clearcoat", clearcoat).orLeaveOut(),
    object("KHR_materials_sheen", sheen).orLeaveOut(),
    object("KHR_materials_transmission", transmission).orLeaveOut(),
    object("KHR_materials_pbrSpecularGlossiness", specularGlossiness).orLeaveOut()};

constexpr SchemaRule material[] = {object("pbrMetallicRoughness", metallicRoughness).orLeaveOut(),
                                   object("normalTexture", normalTexture).orLeaveOut(),
                                   object("occlusionTexture", occlusionTexture).orLeaveOut(),
                                   map("emissiveTexture"),
                                   number("emissiveFactor").list(3, 3).orLeaveOut().clamped(0, 1),
                                   choice("alphaMode", "OPAQUE MASK BLEND").orLeaveOut(),
                                   number("alphaCutoff").orLeaveOut().clamped(0, largestFloat),
                                   rule("doubleSided", Kind::Boolean).orLeaveOut(),
                                   name,
                                   object("extensions", materialExtensions).orLeaveOut(),
                                   extras};

// --------------------------------------------------------------------------------------------------- meshes and nodes

constexpr SchemaRule draco[] = {index("bufferView", "bufferViews").required(),
                                rule("attributes", Kind::Any).required()};
// checkVariantRules() checks variants, so that a faulty mapping costs only itself.
constexpr SchemaRule variants = rule("KHR_materials_variants", Kind::Any);
constexpr SchemaRule primitiveExtensions[] = {object("KHR_draco_mesh_compression", draco), variants};

constexpr SchemaRule primitive[] = {indexMap("attributes", "accessors").required(),
                                    index("indices", "accessors"),
                                    index("material", "materials"),
                                    integer("mode").upTo(6),
                                    indexMap("targets", "accessors").list(),
                                    object("extensions", primitiveExtensions)};

constexpr SchemaRule mesh[] = {object("primitives", primitive).list().required(), number("weights").list(), name,
                               extras};

constexpr SchemaRule instancing[] = {indexMap("attributes", "accessors").required()};
// checkViewRules() checks the lights, so that a faulty one costs only itself.
constexpr SchemaRule punctual = rule("KHR_lights_punctual", Kind::Any);
constexpr SchemaRule visibility[] = {rule("visible", Kind::Boolean).orLeaveOut()};
// validateLods() checks which nodes may be levels.
constexpr SchemaRule lod[] = {index("ids", "nodes").list().required().orLeaveOut()};
constexpr SchemaRule nodeExtensions[] = {object("EXT_mesh_gpu_instancing", instancing), punctual,
                                         object("MSFT_lod", lod).orLeaveOut(),
                                         object("KHR_node_visibility", visibility).orLeaveOut()};

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

// Of cameras, the size of the view counts: checkViewRules() leaves out those without one.
constexpr SchemaRule perspective[] = {number("yfov").orLeaveOut()};
constexpr SchemaRule orthographic[] = {number("ymag").orLeaveOut()};
constexpr SchemaRule camera[] = {choice("type", "perspective orthographic").orLeaveOut(),
                                 object("perspective", perspective).orLeaveOut(),
                                 object("orthographic", orthographic).orLeaveOut(), name};

// ------------------------------------------------------------------------------------------------------ the document

constexpr SchemaRule asset[] = {text("version").required(), text("minVersion"), text("generator").orLeaveOut(),
                                text("copyright").orLeaveOut()};

constexpr SchemaRule documentExtensions[] = {punctual, variants};

constexpr SchemaRule documentMembers[] = {object("asset", asset).required(),
                                          text("extensionsUsed").list(),
                                          text("extensionsRequired").list(),
                                          object("accessors", accessor).list(),
                                          object("animations", animation).list(),
                                          object("buffers", buffer).list(),
                                          object("bufferViews", bufferView).list(),
                                          object("cameras", camera).list(),
                                          object("extensions", documentExtensions).orLeaveOut(),
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
    text += " from " + numberText(rule.least) + " to " + numberText(rule.most);
    if (rule.step != 1.0) text += " in steps of " + numberText(rule.step);
    return text;
}

std::string elementsText(const SchemaRule& rule)
{
    const std::string what = rule.kind == Kind::Number   ? " numbers"
                             : rule.kind == Kind::Index  ? " indices"
                             : rule.kind == Kind::String ? " texts"
                                                         : " objects";
    return (rule.leastCount == rule.mostCount ? "" : "at least ") + std::to_string(rule.leastCount) + what;
}

/// Calls visit(choice) for each choice until it returns true; returns whether a call did.
template <typename Visit>
bool anyChoice(const SchemaRule& rule, const Visit& visit)
{
    for (std::string_view left = rule.choices; !left.empty();)
    {
        const std::size_t end = std::min(left.find(' '), left.size());
        if (visit(left.substr(0, end))) return true;
        left.remove_prefix(std::min(end + 1, left.size()));
    }
    return false;
}

std::string choicesText(const SchemaRule& rule)
{
    std::string list;
    anyChoice(rule,
              [&](std::string_view choice)
              {
                  list += list.empty() ? "one of " : ", ";
                  list += rule.kind == Kind::Choice ? quoted(choice) : std::string(choice);
                  return false;
              });
    return list;
}

class SchemaCheck
{
public:
    SchemaCheck(const JsonValue& document, Report& report) : _document(document), _report(report)
    {
        for (const JsonValue& member : document)
            if (member.is(Type::Array)) _sizes.emplace_back(member.key(), member.size());
    }

    /// The first fault that the document must be refused for.
    std::optional<Error> run()
    {
        checkObject(_document, documentMembers, std::size(documentMembers));
        return _error;
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
        if (refuse && !_error) _error = _finding;
        if (!refuse) _report.warn(_finding.message + "; left out");
        return !refuse;
    }

    bool checkMissing(const SchemaRule& rule)
    {
        _path.push_back({rule.name});
        const char* const expected = rule.isList ? "an array" : rule.kind == Kind::Object ? "an object" : "a value";
        const Outcome outcome = find(rule.onFault, expected, "nothing");
        _path.pop_back();
        if (outcome == Outcome::Refuse)
            _error = _finding;
        else
            _report.warn(_finding.message);
        return outcome != Outcome::Refuse;
    }

    Outcome checkList(const JsonValue& value, const SchemaRule& rule)
    {
        if (!value.is(Type::Array)) return wrong(rule, "an array of " + elementsText(rule), value);
        if (value.size() == 0 && !rule.isRequired && rule.leastCount <= 1)
            return find(OnFault::LeaveOut, elementsText(rule), "none");
        if (value.size() < rule.leastCount || value.size() > rule.mostCount)
            return wrong(rule, elementsText(rule), value);
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
        if (number >= rule.least && number <= rule.most) return Outcome::Good;
        if (rule.onRange != OnFault::Clamp) return find(rule.onRange, rangeText(rule), value.description());
        const double nearest = std::clamp(number, rule.least, rule.most);
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
        if (number < rule.least || number > rule.most || (rule.step != 1.0 && std::fmod(number, rule.step) != 0.0))
            return find(rule.onRange, rangeText(rule), value.description());
        return Outcome::Good;
    }

    Outcome checkIndex(const JsonValue& value, const SchemaRule& rule)
    {
        const auto found = std::find_if(_sizes.begin(), _sizes.end(),
                                        [&](const auto& entry) { return entry.first == rule.collection; });
        const std::size_t size = found == _sizes.end() ? 0 : found->second;
        if (value.isInteger() && value.number() >= 0.0 && value.number() < double(size)) return Outcome::Good;
        return wrong(rule, "an index below " + std::to_string(size) + " of " + std::string(rule.collection), value);
    }

    Outcome checkChoice(const JsonValue& value, const SchemaRule& rule)
    {
        const bool isText = rule.kind == Kind::Choice;
        if (value.is(isText ? Type::String : Type::Number))
        {
            const std::string given = isText ? std::string(value.text()) : numberText(value.number());
            if (anyChoice(rule, [&](std::string_view choice) { return choice == given; })) return Outcome::Good;
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
    std::vector<std::pair<std::string_view, std::size_t>> _sizes; ///< of the arrays of the document
    std::vector<Step> _path;
    Error _finding; ///< the last fault, recorded while its path is known
    std::optional<Error> _error;
};

} // namespace

std::optional<Error> checkSchema(const JsonValue& document, Report& report)
{
    return SchemaCheck(document, report).run();
}

} // namespace osgGpuAnimation::gltf
