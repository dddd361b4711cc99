// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <glm/vec3.hpp>

#include <map>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A pose of an imported model: the CPU twin's vertices, in double precision and in the file's own axes.
class ModelVertices
{
public:
    /// clip: index in the set, -1: the rest pose. fixedWeights: by the file's node, replace the clip's weights.
    ModelVertices(const ImportedModel& model, int clip, double time,
                  const std::map<int, std::vector<double>>& fixedWeights = {});

    const std::vector<AffineMatrix>& jointToModel() const { return _jointToModel; }
    /// One position for each vertex of the file's primitive.
    std::vector<glm::dvec3> positions(const ImportedPrimitive& primitive) const;

private:
    std::vector<AffineMatrix> _palette, _jointToModel;
};

} // namespace osgGpuAnimation::gltf
