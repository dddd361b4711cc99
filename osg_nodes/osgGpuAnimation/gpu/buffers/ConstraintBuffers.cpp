// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/ConstraintBuffers.h>

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <layout.glsl>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The uniforms of a step, see layout.glsl. entries: the texels of the palette entries.
std::vector<glm::vec4> constantsOf(const AnimationSet& set, const ConstraintStep& step,
                                   const std::vector<glm::vec4>& entries)
{
    const ConstraintChain& chain = set.constraintChains()[step.constraint];
    const auto entry = static_cast<std::size_t>(set.mainEntry(step.path.front())) * POSE_TEXELS_PER_ENTRY;
    std::vector<glm::vec4> constants{{entries[entry].x, static_cast<float>(step.constraint), 0.0f, 0.0f}};
    for (std::size_t row = 1; row <= 3; ++row)
        constants.push_back(entries[entry + row]);
    const auto add = [&](const glm::dvec3& xyz, double w)
    { constants.emplace_back(glm::vec3(xyz), static_cast<float>(w)); };
    if (chain.isLookAt)
    {
        add(chain.forward, chain.hasCone() ? std::cos(chain.cone) : -2.0);
        add(chain.up, std::sin(chain.cone));
        add(chain.offset, 0.0);
    }
    else
        add(chain.hinge, chain.softReach);
    constants.resize(POSE_TEXELS_PER_CONSTRAINT, glm::vec4(0.0f));
    for (std::size_t joint = 0; joint < chain.joints.size(); ++joint)
    {
        const JointTransform& rest = set.restPose()[static_cast<std::size_t>(chain.joints[joint])];
        constants.emplace_back(static_cast<float>(chain.joints[joint]),
                               static_cast<float>(step.sources[step.chainBegin + joint].code()),
                               chain.isLookAt ? static_cast<float>(chain.shares[joint]) : 0.0f, 0.0f);
        constants.push_back(rest.translation);
        constants.push_back(rest.scale);
    }
    return constants;
}

} // namespace

ConstraintBuffers::ConstraintBuffers(osg::GLExtensions& gl, const AnimationSet& set, std::uint64_t active,
                                     std::vector<glm::vec4> entries)
    : _plan(set.skeleton(), set.constraintChains(), active), _isCorrected(set.paletteSize(), false),
      _entries(gl, GL_RGBA32F_ARB), _jointsAbove(gl, GL_RGBA32F_ARB)
{
    for (std::size_t e = 0; e < set.levels().back(); ++e)
    {
        const PaletteEntry& entry = set.palette()[e];
        if (entry.kind != PaletteEntry::Kind::Joint) continue;
        const int code = _plan.correctionsOfJoints[static_cast<std::size_t>(entry.joint)].code();
        entries[e * POSE_TEXELS_PER_ENTRY].w = static_cast<float>(code);
        _isCorrected[e] = code > 0;
    }
    _entries.upload(entries.data(), entries.size() * sizeof(glm::vec4));
    std::vector<glm::vec4> jointsAbove;
    for (const ConstraintStep& step : _plan.steps)
    {
        _constants.push_back(constantsOf(set, step, entries));
        _firstAbove.push_back(static_cast<int>(jointsAbove.size()));
        for (std::size_t place = 0; place < step.chainBegin; ++place)
            jointsAbove.emplace_back(static_cast<float>(step.path[place]),
                                     static_cast<float>(step.sources[place].code()), 0.0f, 0.0f);
    }
    _jointsAbove.upload(jointsAbove.data(), jointsAbove.size() * sizeof(glm::vec4));
}

std::size_t ConstraintBuffers::endOfRun(std::size_t first, std::size_t end) const
{
    const auto begin = _isCorrected.begin() + static_cast<std::ptrdiff_t>(first);
    const auto found = std::find(begin, _isCorrected.begin() + static_cast<std::ptrdiff_t>(end), !_isCorrected[first]);
    return static_cast<std::size_t>(found - _isCorrected.begin());
}

void ConstraintBuffers::release()
{
    _entries.release();
    _jointsAbove.release();
}

} // namespace osgGpuAnimation
