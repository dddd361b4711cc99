// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <glm/vec3.hpp>

#include <map>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A pose of an imported model, computed on the CPU in double precision from the import's output: the palette for
/// SkinnedGeometry, the transforms above for plain geometry. Coordinates are in the file's own axes.
class ModelVertices
{
public:
    /// clip: index in the set, -1: the rest pose. fixedWeights: by the file's node, replace the clip's weights.
    ModelVertices(const ImportedModel& model, int clip, double time,
                  const std::map<int, std::vector<double>>& fixedWeights = {});

    const std::vector<AffineMatrix>& palette() const { return _palette; }
    const std::vector<AffineMatrix>& jointToModel() const { return _jointToModel; }
    std::vector<double> weights(int morph) const;
    /// One position for each vertex of the file's primitive.
    std::vector<glm::dvec3> positions(const ImportedPrimitive& primitive) const;

private:
    glm::dvec3 morphed(const ImportedPrimitive& primitive, std::size_t vertex) const;
    glm::dvec3 placed(const ImportedPrimitive& primitive, std::size_t vertex) const;

    const ImportedModel& _model;
    const std::map<int, std::vector<double>> _fixedWeights;
    std::vector<AffineMatrix> _palette;
    std::vector<AffineMatrix> _jointToModel;
};

} // namespace osgGpuAnimation::gltf
