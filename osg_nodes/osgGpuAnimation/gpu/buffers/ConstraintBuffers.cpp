// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/ConstraintBuffers.h>

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <layout.glsl>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

void addTexels(const AnimationSet& set, const ConstraintStep& step, std::vector<glm::vec4>& texels)
{
    const ConstraintChain& chain = set.constraintChains()[step.constraint];
    const auto texel = [&](const glm::dvec3& xyz, double w)
    { texels.emplace_back(glm::vec3(xyz), static_cast<float>(w)); };
    const auto entry = static_cast<float>(set.mainEntry(step.path.front()));
    texels.emplace_back(entry, static_cast<float>(step.constraint), 0.0f, 0.0f);
    constexpr double wholeCone = 3.14159;
    if (chain.isLookAt)
    {
        texel(chain.forward, chain.cone < wholeCone ? std::cos(chain.cone) : -2.0);
        texel(chain.up, std::sin(chain.cone));
        texel(chain.offset, 0.0);
    }
    else
    {
        texel(chain.hinge, chain.softReach);
        texels.resize(texels.size() + 2, glm::vec4(0.0f));
    }
    for (std::size_t place = 0; place < step.path.size(); ++place)
    {
        const bool hasShare = chain.isLookAt && place >= step.chainBegin;
        texels.emplace_back(static_cast<float>(step.path[place]), static_cast<float>(step.sources[place].code()),
                            hasShare ? static_cast<float>(chain.shares[place - step.chainBegin]) : 0.0f, 0.0f);
    }
}

} // namespace

ConstraintBuffers::ConstraintBuffers(osg::GLExtensions& gl, const AnimationSet& set, std::uint64_t active,
                                     std::vector<glm::vec4> entries)
    : _plan(set.skeleton(), set.constraintChains(), active), _hasCorrections(set.levelCount(), false),
      _entries(gl, GL_RGBA32F_ARB), _constants(gl, GL_RGBA32F_ARB)
{
    for (std::size_t level = 0; level < set.levelCount(); ++level)
        for (std::size_t e = set.levels()[level]; e < set.levels()[level + 1]; ++e)
        {
            const PaletteEntry& entry = set.palette()[e];
            if (entry.kind != PaletteEntry::Kind::Joint) continue;
            const int code = _plan.correctionsOfJoints[static_cast<std::size_t>(entry.joint)].code();
            entries[e * POSE_TEXELS_PER_ENTRY].w = static_cast<float>(code);
            if (code > 0) _hasCorrections[level] = true;
        }
    _entries.upload(entries.data(), entries.size() * sizeof(glm::vec4));
    std::vector<glm::vec4> constants;
    for (const ConstraintDraw& draw : _plan.draws)
    {
        _firstTexels.push_back(static_cast<int>(constants.size()));
        for (std::size_t step = draw.first; step < draw.first + draw.count; ++step)
            addTexels(set, _plan.steps[step], constants);
    }
    _constants.upload(constants.data(), constants.size() * sizeof(glm::vec4));
}

void ConstraintBuffers::release()
{
    _entries.release();
    _constants.release();
}

} // namespace osgGpuAnimation
