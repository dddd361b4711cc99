// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Node>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// 2,000 people of 24 outfits and three sizes in a street, in one AnimatedCrowd: some stand in groups and talk, the
/// others walk one way or the other. model: People.glb. outfits: People.outfits.json.
Result<osg::ref_ptr<osg::Node>> makeStreet(osg::Node& model, const std::string& outfits);

/// The outfits, eight people of one size in each row; they walk. model, outfits: those of makeStreet().
Result<std::vector<osg::ref_ptr<osg::Node>>> makeOutfitRows(osg::Node& model, const std::string& outfits);

} // namespace osgGpuAnimation
