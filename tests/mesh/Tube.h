// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <vector>

namespace osgGpuAnimation
{

constexpr unsigned int tubeColumns = 64, tubeRows = 16;
constexpr unsigned int tubeTriangles = 2 * tubeColumns * tubeRows;

/// Two joints; the second, 4 units along x, rotates by 90 degrees about z during the clip's second. hasMorph: adds a
/// weight that rises from 0 to 1 during the clip.
std::shared_ptr<const AnimationSet> armSet(bool hasMorph = false);

/// A tube of 1,024 quads along x from 0 to 8, with open ends, that the two joints bend in the middle; it has only
/// positions and influences.
osg::ref_ptr<SkinnedGeometry> makeTube(const AnimationSet& set);

/// The same tube with normals, lit and white; if the set has a morph, it thickens the tube's first half.
osg::ref_ptr<SkinnedGeometry> makeShownTube(const AnimationSet& set);

/// The shown tube, cut across into that many meshes of equally many columns. They share one StateSet.
std::vector<osg::ref_ptr<SkinnedGeometry>> makeTubeParts(const AnimationSet& set, unsigned int count);

/// A character with such a tube that plays the clip.
osg::ref_ptr<AnimatedCharacter> makeTubeCharacter(std::shared_ptr<const AnimationSet> set);

/// A clone with nodes of its own.
inline osg::ref_ptr<AnimatedCharacter> cloneOf(const AnimatedCharacter& character)
{
    return osg::clone(&character, osg::CopyOp::DEEP_COPY_NODES);
}

} // namespace osgGpuAnimation
