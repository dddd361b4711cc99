// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>
#include <osg/NodeVisitor>

namespace osgGpuAnimation
{

/// For nodes whose vertices nobody may transform, from their traverse(): where the visitor is the Optimizer's that
/// flattens static transforms and duplicates what is shared, the transforms above are groups by now and what they did
/// is to be done to the vertices below. Instead the node gets a transform of its own in its parent. True: the visitor
/// is not to go on below the node.
bool keepFlattenedPlace(osg::Node& node, osg::NodeVisitor& visitor);

} // namespace osgGpuAnimation
