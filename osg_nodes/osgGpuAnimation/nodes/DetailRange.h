// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/DetailLevels.h>

#include <osg/Group>

namespace osgGpuAnimation
{

/// The levels of detail that some meshes have triangles for, from the finest to the coarsest of all: what is drawn at
/// levels beyond is the same, so those need not be told apart.
class DetailRange
{
public:
    DetailRange() = default;
    /// Of the SkinnedGeometry among a group's children; makes levels where there are none yet.
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
