// SPDX-License-Identifier: MIT
#pragma once

#include "tool/PoseEvaluator.h"

#include <nlohmann/json.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::tool
{

/// The poses to compute of a file. Numbers of nodes, primitives and animations are those of the file.
struct PoseRequest
{
    /// Morph weights that override the weights of the clip and of the file.
    struct FixedWeights
    {
        int node = -1;
        std::vector<double> weights;
    };
    using PrimitiveKey = std::pair<int, int>; ///< node, and primitive within its mesh

    std::optional<int> animation; ///< the clip, by the file's number
    std::optional<std::string>
        clip;                  ///< the clip by its name, or by number where none has that name; default: the first
    bool bind = false;         ///< no clip: the nodes at rest
    std::vector<double> times; ///< seconds from the beginning of the clip
    std::vector<FixedWeights> fixedWeights;
    /// The vertices whose positions are computed. For a primitive that is not listed: all if there are at most 64, else
    /// 64 spread evenly.
    std::map<PrimitiveKey, std::vector<std::uint32_t>> sampled;
};

/// The request that a document of schema gltf-pose/1 answers: its clip, times, set weights and vertices.
/// Errors name the member: not readable, not JSON, another schema, a missing member or one of another type.
Result<PoseRequest> readPoseRequest(const std::string& fileName);

/// Poses in the schema gltf-pose/1: JSON, in the file's own axes, units and numbers; matrices are 16 numbers,
/// column-major for column vectors. A pose holds the world matrix of every node that is a joint (null for others), the
/// joint matrices by skin, the morph weights, and of each primitive its bounding box and the requested vertices.
/// `modelSize` is the diagonal of the first pose's box; comparisons divide lengths by it (errors of compact clips refer
/// to the longest side at rest instead).
class PoseDocument
{
public:
    /// The model was imported with noRotation and outlives the document. clip: of the model's set, -1: none.
    /// Error: the request names a vertex that a primitive does not have.
    static Result<PoseDocument> create(const gltf::ImportedModel& model, const PoseRequest& request, int clip,
                                       const std::string& fileName, const std::string& evaluator);

    /// pose: as an evaluator made it; empty for a model without a character.
    void add(double time, const EvaluatedPose& pose);

    /// The document as text, with a line break at its end.
    std::string text() const;

private:
    explicit PoseDocument(const gltf::ImportedModel& model) : _model(model) {}

    void addHeader(const PoseRequest& request, int clip, const std::string& fileName, const std::string& evaluator);
    void addSkins();
    Result<void> addPrimitives(const PoseRequest& request);
    nlohmann::ordered_json nodeMatrices(const EvaluatedPose& pose) const;
    nlohmann::ordered_json skinMatrices(const EvaluatedPose& pose) const;
    nlohmann::ordered_json weights(const EvaluatedPose& pose) const;
    std::vector<glm::dvec3> positions(std::size_t primitive, const EvaluatedPose& pose) const;

    const gltf::ImportedModel& _model;
    nlohmann::ordered_json _document;
    std::vector<std::vector<std::uint32_t>> _sampled; ///< one list per primitive
};

} // namespace osgGpuAnimation::tool
