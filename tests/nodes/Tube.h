// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

namespace osgGpuAnimation
{

constexpr unsigned int tubeColumns = 64, tubeRows = 16;
constexpr unsigned int tubeTriangles = 2 * tubeColumns * tubeRows;

/// Two joints, of which the second, 4 units along x, bends by a quarter about z within the clip's second.
/// hasMorph: of a weight that goes from 0 to 1 in the meantime.
std::shared_ptr<const AnimationSet> armSet(bool hasMorph = false);

/// A tube along x from 0 to 8, open at its ends, that the two joints bend in the middle: positions and influences
/// alone, 1,024 quads.
osg::ref_ptr<SkinnedGeometry> makeTube(const AnimationSet& set);

/// The same to look at: with normals, lit and white; where the set has a morph, the tube's first half grows thick.
osg::ref_ptr<SkinnedGeometry> makeShownTube(const AnimationSet& set);

/// One of such a tube, which plays the clip.
osg::ref_ptr<AnimatedCharacter> makeTubeCharacter(std::shared_ptr<const AnimationSet> set);

} // namespace osgGpuAnimation
