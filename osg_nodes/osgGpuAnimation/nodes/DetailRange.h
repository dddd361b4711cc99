// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>
#include <osgGpuAnimation/nodes/DetailLevels.h>

#include <osg/Group>

#include <string>

namespace osgGpuAnimation
{

/// The levels of detail that some meshes have triangles for, from the finest to the coarsest of all: what is drawn at
/// levels beyond is the same, so those need not be told apart.
class DetailRange
{
public:
    /// Vertices of a group's meshes together that levels are made of: meshes that come later are drawn whole, unless
    /// another group shows them too.
    static constexpr std::size_t mostVertices = 10 * DetailLevels::mostVertices;
    static constexpr int largestPixelError = 1'000'000;

    /// What setPixelError() of characters and crowds takes.
    static bool isPixelError(double pixels) { return pixels >= 0.0 && pixels <= largestPixelError; }
    /// In words: what it must be.
    static std::string pixelErrorsTaken();
    /// Makes the levels of the SkinnedGeometry among a group's children that are drawn with that pixel error: none
    /// where it is 0, or the set has nothing to draw. Error: it is no pixel error.
    static Result<bool> prepare(float pixels, const osg::Group& meshes, const AnimationSet& set);

    DetailRange() = default;
    /// Of the SkinnedGeometry among a group's children; makes levels where there are none yet. Nothing else does:
    /// what else is drawn at a level is drawn whole.
    DetailRange(const osg::Group& meshes, const AnimationSet& set);

    int held(int level) const
    {
        return level < _finest ? DetailLevels::allTriangles : level > _coarsest ? _coarsest : level;
    }

private:
    int _finest = std::numeric_limits<int>::max();
    int _coarsest = DetailLevels::allTriangles;
};

} // namespace osgGpuAnimation
