// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/constraints/ConstraintPlan.h>
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>

#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

class AnimationSet;

/// The static GPU data for the evaluation of some constraints of a set, in one graphics context. The constructor
/// uploads it.
class ConstraintBuffers
{
public:
    /// active: bit c for constraint c. entries: the texels of the set's palette entries (see layout.glsl).
    ConstraintBuffers(osg::GLExtensions& gl, const AnimationSet& set, std::uint64_t active,
                      std::vector<glm::vec4> entries);

    const ConstraintPlan& plan() const { return _plan; }
    /// RGBA32F: the palette entries with the codes of their corrections.
    const BufferTexture& entries() const { return _entries; }
    /// RGBA32F: the numbers and the path of each constraint, see layout.glsl.
    const BufferTexture& constants() const { return _constants; }
    /// The first texel of a draw's first step in constants(). draw: index in the plan.
    int firstTexel(std::size_t draw) const { return _firstTexels[draw]; }
    /// True if the draw exists and must come before that level of the palette. draw: index in the plan.
    bool isSolvedBefore(std::size_t level, std::size_t draw) const
    {
        return draw < _plan.draws.size() && _plan.steps[_plan.draws[draw].first].level == level;
    }
    /// True if constraints correct the rotation of an entry of that level of the palette.
    bool hasCorrections(std::size_t level) const { return _hasCorrections[level]; }

    void release();

private:
    ConstraintPlan _plan;
    std::vector<int> _firstTexels;
    std::vector<bool> _hasCorrections; ///< by level
    BufferTexture _entries;
    BufferTexture _constants;
};

} // namespace osgGpuAnimation
