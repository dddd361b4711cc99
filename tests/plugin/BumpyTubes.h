// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ModelBuilder.h"

#include <cmath>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A mesh of 264 triangles: a tube with bumps.
inline int bumpyTube(ModelBuilder& model)
{
    constexpr unsigned int sides = 12, rings = 12;
    std::vector<float> positions, normals;
    std::vector<unsigned int> indices;
    for (unsigned int ring = 0; ring < rings; ++ring)
        for (unsigned int side = 0; side < sides; ++side)
        {
            const float angle = 6.2831853f * static_cast<float>(side) / sides;
            const float radius = 0.5f + 0.02f * static_cast<float>((7 * side + 5 * ring) % 4);
            positions.insert(positions.end(),
                             {radius * std::cos(angle), radius * std::sin(angle), 0.25f * static_cast<float>(ring)});
            normals.insert(normals.end(), {std::cos(angle), std::sin(angle), 0.0f});
        }
    for (unsigned int ring = 0; ring + 1 < rings; ++ring)
        for (unsigned int side = 0; side < sides; ++side)
        {
            const unsigned int next = (side + 1) % sides, low = ring * sides, high = low + sides;
            indices.insert(indices.end(), {low + side, low + next, high + next, low + side, high + next, high + side});
        }
    return model.mesh({{"POSITION", model.floats(TINYGLTF_TYPE_VEC3, positions)},
                       {"NORMAL", model.floats(TINYGLTF_TYPE_VEC3, normals)}},
                      TINYGLTF_MODE_TRIANGLES,
                      model.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, indices));
}

/// Two tubes, on an arm that slides and on its hand: both have levels of detail, and merged ones together.
inline ModelBuilder bumpyTubes()
{
    ModelBuilder model;
    const int arm = model.node("arm"), tube = bumpyTube(model);
    model.node("upper", arm, tube);
    model.node("lower", model.node("hand", arm), bumpyTube(model));
    model.slidingClip("Slide", arm);
    return model;
}

} // namespace osgGpuAnimation::gltf
