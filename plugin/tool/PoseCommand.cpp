// SPDX-License-Identifier: MIT
#include "tool/Commands.h"

#include "gltf/file/Elements.h"
#include "gltf/file/SavedFile.h"
#include "tool/PoseEvaluator.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/math/detail/RegularFile.h>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <osg/BoundingBox>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <utility>

namespace osgGpuAnimation::tool
{

namespace
{

using nlohmann::ordered_json;

/// The poses to compute of a file. Numbers of nodes, primitives and animations are those of the file.
struct PoseRequest
{
    std::optional<int> animation; ///< the clip, by the file's number; none: the one that the import has found
    bool bind = false;            ///< no clip: the nodes at rest
    std::vector<double> times;    ///< seconds from the beginning of the clip
    std::vector<std::pair<int, std::vector<double>>> fixedWeights; ///< of nodes; override the clip's and the file's
    /// The vertices whose positions are computed, by node and primitive within its mesh. For a primitive that is not
    /// listed: see spreadVertices().
    std::map<std::pair<int, int>, std::vector<std::uint32_t>> sampled;
};

PoseRequest readRequest(const nlohmann::json& document)
{
    PoseRequest request;
    const nlohmann::json& clip = document.at("clip");
    request.bind = clip.is_null();
    if (!request.bind) request.animation = clip.at("index").get<int>();
    for (const nlohmann::json& frame : document.at("frames"))
        request.times.push_back(frame.at("time").get<double>());
    for (const nlohmann::json& fixed : document.value("fixedWeights", nlohmann::json()))
        request.fixedWeights.emplace_back(fixed.at("node").get<int>(), fixed.at("weights").get<std::vector<double>>());
    for (const nlohmann::json& primitive : document.value("primitives", nlohmann::json()))
        request.sampled[{primitive.at("node").get<int>(), primitive.at("primitive").get<int>()}] =
            primitive.at("sampled").get<std::vector<std::uint32_t>>();
    return request;
}

/// The request that a document of schema gltf-pose/1 answers. Errors name the member: not readable, not JSON, another
/// schema, a missing member or one of another type.
Result<PoseRequest> readPoseRequest(const std::string& fileName)
{
    constexpr std::uint64_t maxBytes = std::uint64_t(1) << 30;
    const Result<std::string> text = RegularFile::readWhole(fileName, maxBytes);
    if (!text) return text.error();
    try
    {
        const nlohmann::json document = nlohmann::json::parse(text.value());
        if (!document.is_object() || document.value("schema", "") != "gltf-pose/1")
            return Error{"is not a document of schema gltf-pose/1"};
        return readRequest(document);
    }
    catch (const nlohmann::json::exception& fault)
    {
        return Error{fault.what()};
    }
}

/// Null for an invalid box.
ordered_json jsonOf(const osg::BoundingBoxd& box)
{
    if (!box.valid()) return nullptr;
    return {{box.xMin(), box.yMin(), box.zMin()}, {box.xMax(), box.yMax(), box.zMax()}};
}

ordered_json sixteenNumbers(const glm::dmat4& matrix)
{
    ordered_json numbers = ordered_json::array();
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row)
            numbers.push_back(matrix[column][row]);
    return numbers;
}

/// Without a request: all vertices if there are at most 64, else 64 spread evenly; none if nothing deforms the
/// primitive.
std::vector<std::uint32_t> spreadVertices(const gltf::ImportedPrimitive& primitive)
{
    if (primitive.skin < 0 && primitive.targets == 0) return {};
    std::vector<std::uint32_t> vertices(std::min<std::size_t>(primitive.vertexCount, 64));
    for (std::size_t i = 0; i < vertices.size(); ++i)
        vertices[i] = static_cast<std::uint32_t>(i * primitive.vertexCount / vertices.size());
    return vertices;
}

ordered_json nullIfEmpty(const std::string& text)
{
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

/// Poses in the schema gltf-pose/1, see PoseCommand.
class PoseDocument
{
public:
    /// The model was imported with noRotation. clip: of the model's set, -1: none.
    PoseDocument(const gltf::ImportedModel& model, const PoseRequest& request, int clip, const std::string& fileName,
                 const std::string& evaluator)
        : _model(model)
    {
        _document["schema"] = "gltf-pose/1";
        _document["asset"] = {{"file", std::filesystem::path(fileName).filename().string()},
                              {"generator", nullIfEmpty(_model.generator)}};
        _document["evaluator"] = evaluator;
        _document["scene"] = _model.scene;
        _document["clip"] = nullptr;
        if (clip >= 0)
        {
            const Clip& played = gltf::elementOf(_model.set->clips(), clip);
            _document["clip"] = {{"index", gltf::elementOf(_model.animationOfClip, clip)},
                                 {"name", nullIfEmpty(played.name())},
                                 {"duration", played.duration()}};
        }
        _document["modelSize"] = 1.0;
        _document["nodeNames"] = ordered_json::array();
        for (const std::string& name : _model.nodeNames)
            _document["nodeNames"].push_back(nullIfEmpty(name));
        _document["nodeParents"] = _model.nodeParents;
        _document["fixedWeights"] = ordered_json::array();
        for (const auto& [node, weights] : request.fixedWeights)
            _document["fixedWeights"].push_back({{"node", node}, {"weights", weights}});
        ordered_json& skins = _document["skins"] = ordered_json::array();
        for (std::size_t skin = 0; _model.set && skin < _model.set->skins().size(); ++skin)
        {
            std::vector<int> nodes;
            for (int joint : _model.set->skins()[skin].joints)
                nodes.push_back(_model.set->skeleton().joint(static_cast<std::size_t>(joint)).sourceNode);
            skins.push_back({{"skin", skin}, {"name", nullIfEmpty(_model.set->skins()[skin].name)}, {"joints", nodes}});
        }
    }

    /// Call it once, before the poses. Error: the request names a vertex that a primitive does not have.
    Result<void> addPrimitives(const PoseRequest& request)
    {
        ordered_json& primitives = _document["primitives"] = ordered_json::array();
        _document["frames"] = ordered_json::array();
        for (const gltf::ImportedPrimitive& drawn : _model.primitives)
            for (const int number : *drawn.primitives)
            {
                const auto wanted = request.sampled.find({drawn.node, number});
                _sampled.push_back(wanted != request.sampled.end() ? wanted->second : spreadVertices(drawn));
                for (std::uint32_t vertex : _sampled.back())
                    if (vertex >= drawn.vertexCount)
                        return Error{"primitive " + std::to_string(number) + " of node " + std::to_string(drawn.node) +
                                     ": vertex " + std::to_string(vertex) + " is asked for, it has " +
                                     std::to_string(drawn.vertexCount)};
                primitives.push_back({{"node", drawn.node},
                                      {"mesh", drawn.mesh},
                                      {"primitive", number},
                                      {"skin", drawn.skin < 0 ? ordered_json(nullptr) : ordered_json(drawn.skin)},
                                      {"targets", drawn.targets},
                                      {"vertices", drawn.vertexCount},
                                      {"influences", drawn.influences},
                                      {"sampled", _sampled.back()}});
            }
        return {};
    }

    /// pose: as an evaluator made it; empty for a model without a character.
    void add(double time, const EvaluatedPose& pose)
    {
        ordered_json primitives = ordered_json::array();
        osg::BoundingBoxd whole;
        for (std::size_t p = 0; p < _model.primitives.size(); ++p)
        {
            osg::BoundingBoxd box;
            const std::vector<glm::dvec3> all = positions(p, pose);
            for (const glm::dvec3& position : all)
                box.expandBy(position.x, position.y, position.z);
            whole.expandBy(box);
            for (std::size_t i = 0; i < _model.primitives[p].primitives->size(); ++i)
            {
                ordered_json primitive = {{"bbox", jsonOf(box)}};
                for (std::uint32_t vertex : _sampled[primitives.size()])
                    primitive["positions"].push_back({all[vertex].x, all[vertex].y, all[vertex].z});
                primitives.push_back(std::move(primitive));
            }
        }
        if (const double diagonal = 2.0 * whole.radius();
            _document["frames"].empty() && whole.valid() && diagonal > 0.0)
            _document["modelSize"] = diagonal;
        _document["frames"].push_back({{"time", time},
                                       {"nodes", nodeMatrices(pose)},
                                       {"skins", skinMatrices(pose)},
                                       {"weights", weights(pose)},
                                       {"primitives", std::move(primitives)},
                                       {"bbox", jsonOf(whole)}});
    }

    std::string text() const { return _document.dump() + "\n"; }

private:
    ordered_json nodeMatrices(const EvaluatedPose& pose) const
    {
        ordered_json matrices = ordered_json::array();
        for (std::size_t node = 0; node < _model.nodeParents.size(); ++node)
        {
            const int joint = _model.set ? _model.set->skeleton().jointOfSourceNode(static_cast<int>(node)) : -1;
            matrices.push_back(nullptr);
            if (joint < 0) continue;
            // A palette entry is jointToModel · inverseBind.
            const auto entry = static_cast<std::size_t>(_model.set->mainEntry(joint));
            const glm::dmat4 inverseBind = _model.set->palette()[entry].inverseBind.toColumns();
            if (glm::determinant(inverseBind) == 0.0) continue;
            matrices.back() = sixteenNumbers(pose.palette[entry].toColumns() * glm::inverse(inverseBind));
        }
        return matrices;
    }

    ordered_json skinMatrices(const EvaluatedPose& pose) const
    {
        ordered_json skins = ordered_json::array();
        for (std::size_t skin = 0; _model.set && skin < _model.set->skins().size(); ++skin)
        {
            ordered_json matrices = ordered_json::array();
            for (std::size_t place = 0; place < _model.set->skins()[skin].joints.size(); ++place)
            {
                const auto entry = static_cast<std::size_t>(_model.set->entryOfSkin(skin, place));
                matrices.push_back(sixteenNumbers(pose.palette[entry].toColumns()));
            }
            skins.push_back(std::move(matrices));
        }
        return skins;
    }

    ordered_json weights(const EvaluatedPose& pose) const
    {
        ordered_json all = ordered_json::array();
        for (std::size_t morph = 0; _model.set && morph < _model.set->morphs().size(); ++morph)
        {
            const MorphWeights& weights = _model.set->morphs()[morph];
            if (weights.isProperty()) continue;
            ordered_json numbers = ordered_json::array();
            for (std::size_t w = 0; w < weights.defaults.size(); ++w)
            {
                const std::size_t entry =
                    static_cast<std::size_t>(_model.set->entryOfMorph(morph)) + w / MorphWeights::weightsPerBlock;
                const std::size_t place = w % MorphWeights::weightsPerBlock;
                numbers.push_back(pose.palette[entry].rows[place / 4][static_cast<glm::length_t>(place % 4)]);
            }
            all.push_back({{"node", weights.sourceNode}, {"weights", std::move(numbers)}});
        }
        return all;
    }

    /// One position a vertex of the file.
    std::vector<glm::dvec3> positions(std::size_t primitive, const EvaluatedPose& pose) const
    {
        const gltf::ImportedPrimitive& source = _model.primitives[primitive];
        std::vector<glm::dvec3> ofGeometry =
            primitive < pose.positions.size() ? pose.positions[primitive] : std::vector<glm::dvec3>();
        if (ofGeometry.empty())
        {
            const auto* still = dynamic_cast<const osg::Vec3Array*>(source.geometry->getVertexArray());
            for (std::size_t v = 0; still && v < still->size(); ++v)
            {
                const osg::Vec3d placed = osg::Vec3d((*still)[v]) * source.toModel;
                ofGeometry.emplace_back(placed.x(), placed.y(), placed.z());
            }
        }
        if (!source.geometryVertex) return ofGeometry;
        std::vector<glm::dvec3> ofFile;
        for (std::uint32_t vertex : *source.geometryVertex)
            ofFile.push_back(vertex < ofGeometry.size() ? ofGeometry[vertex] : glm::dvec3(0.0));
        return ofFile;
    }

    const gltf::ImportedModel& _model;
    ordered_json _document;
    std::vector<std::vector<std::uint32_t>> _sampled; ///< one list per primitive
};

/// The set's clip for the request, -1 for none.
Result<int> findClip(const gltf::ImportedModel& model, const PoseRequest& request)
{
    if (request.animation)
    {
        const auto& numbers = model.animationOfClip;
        const auto found = std::find(numbers.begin(), numbers.end(), *request.animation);
        if (found == numbers.end())
            return Error{"animations[" + std::to_string(*request.animation) + "]: there is no such clip"};
        return static_cast<int>(found - numbers.begin());
    }
    // The import has found the clip by its name, or refused the file, and plays it.
    return request.bind || !model.character ? -1 : model.character->getController().clip();
}

/// Shows the weights that the request sets over the clip.
Result<void> poseWeights(AnimationController& controller, const PoseRequest& request)
{
    for (const auto& [node, weights] : request.fixedWeights)
    {
        const std::string name = "fixedWeights of node " + std::to_string(node);
        const std::vector<MorphWeights>& morphs = controller.set().morphs();
        const auto morph = std::find_if(morphs.begin(), morphs.end(),
                                        [of = node](const MorphWeights& each) { return each.sourceNode == of; });
        if (morph == morphs.end()) return Error{name + ": its mesh has no morph targets"};
        if (morph->defaults.size() != weights.size())
            return Error{name + ": " + std::to_string(weights.size()) + " weights, expected " +
                         std::to_string(morph->defaults.size())};
        for (std::size_t target = 0; target < weights.size(); ++target)
            if (!controller.layer(1).pose().setMorphWeight(static_cast<std::size_t>(morph - morphs.begin()), target,
                                                           static_cast<float>(weights[target])))
                return Error{name + ": weight " + std::to_string(target) + " is out of range"};
    }
    return {};
}

Result<std::string> evaluate(const gltf::ImportedModel& model, const PoseRequest& request, const PoseCommand& command)
{
    const Result<int> clip = findClip(model, request);
    if (!clip) return clip.error();
    AnimationController controller(model.set);
    controller.setLoopMode(LoopMode::Once); // glTF's clips hold at their ends
    if (clip.value() >= 0)
        if (const Result<void> playing = controller.play(static_cast<std::size_t>(clip.value())); !playing)
            return playing.error();
    if (const Result<void> posed = poseWeights(controller, request); !posed) return posed.error();
    Result<PoseEvaluator> evaluator = PoseEvaluator{
        "osggpuanim, nothing moves", [](const PoseInstruction&) -> Result<EvaluatedPose> { return EvaluatedPose(); }};
    if (model.set) evaluator = command.onGpu ? gpuPoseEvaluator(model) : cpuPoseEvaluator(model);
    if (!evaluator) return evaluator.error();
    PoseDocument document(model, request, clip.value(), command.file, evaluator.value().name);
    if (const Result<void> added = document.addPrimitives(request); !added) return added.error();
    for (const double time : request.times)
    {
        controller.seek(time);
        const Result<EvaluatedPose> pose = evaluator.value().evaluate(controller.instruction());
        if (!pose) return pose.error();
        document.add(time, pose.value());
    }
    return document.text();
}

Error named(const std::string& file, const Error& error)
{
    return {file + ": " + error.message};
}

} // namespace

Result<void> PoseCommand::run() const
{
    const Result<PoseRequest> wanted = like.empty() ? PoseRequest{{}, bind, times, {}, {}} : readPoseRequest(like);
    if (!wanted) return named(like, wanted.error());
    PoseRequest request = wanted.value();
    if (request.bind && request.times.empty()) request.times = {0.0};
    const Result<gltf::ImportOptions> given = importOptions(*this);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    options.noRotation = true;
    options.clip = clip;
    const Result<gltf::ImportedModel> model = readModel(file, options);
    if (!model) return named(file, model.error());
    printClipWarnings(file, model.value().messages);
    const Result<std::string> text = evaluate(model.value(), request, *this);
    if (!text) return named(file, text.error());

    if (output.empty())
        return std::cout << text.value() << std::flush ? Result<void>() : Error{"standard output: cannot be written"};
    const Result<void> saved = gltf::saveFile(output, text.value());
    return saved ? saved : named(output, saved.error());
}

} // namespace osgGpuAnimation::tool
