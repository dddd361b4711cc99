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
    /// The uniforms of a step, see layout.glsl. step: index in the plan.
    const std::vector<glm::vec4>& constants(std::size_t step) const { return _constants[step]; }
    /// RGBA32F: of all steps, the joints of the path above the chain: track, code of the correction to read (0: none).
    const BufferTexture& jointsAbove() const { return _jointsAbove; }
    /// The first texel of a step in jointsAbove(). step: index in the plan.
    int firstAbove(std::size_t step) const { return _firstAbove[step]; }
    /// True if the step exists and must come before that level of the palette. step: index in the plan.
    bool isSolvedBefore(std::size_t level, std::size_t step) const
    {
        return step < _plan.steps.size() && _plan.steps[step].level == level;
    }
    /// True if constraints correct the rotation of that palette entry.
    bool isCorrected(std::size_t entry) const { return _isCorrected[entry]; }
    /// The end of the run of entries from `first` on of which all are corrected or none. end: the end of the level.
    std::size_t endOfRun(std::size_t first, std::size_t end) const;

    void release();

private:
    ConstraintPlan _plan;
    std::vector<std::vector<glm::vec4>> _constants; ///< by step
    std::vector<int> _firstAbove;                   ///< by step
    std::vector<bool> _isCorrected;                 ///< by palette entry
    BufferTexture _entries;
    BufferTexture _jointsAbove;
};

} // namespace osgGpuAnimation
