// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Drawable>
#include <osg/ValueObject>

#include <optional>
#include <vector>

namespace osgGpuAnimation
{

// The marks of the import: user values, so that OSG's own serializers keep them. The numbers are the file's.
constexpr const char* materialMark = "osgGpuAnimation.material";     ///< int of a StateSet with animated properties
constexpr const char* lightMark = "osgGpuAnimation.light";           ///< int of the source of an animated PunctualLight
constexpr const char* cameraMark = "osgGpuAnimation.camera";         ///< int of an animated osg::CameraView
constexpr const char* visibilityMark = "osgGpuAnimation.visibility"; ///< of markVisibility()
/// A drawable or a light. nodes: it is visible while all these nodes are.
void markVisibility(osg::Node& node, const std::vector<int>& nodes);

std::optional<int> markOf(const osg::Object& object, const char* mark); ///< empty: it does not have the mark
std::vector<int> visibilityOf(const osg::Object& object);               ///< the nodes of markVisibility()
bool isMeshMarked(const osg::Drawable& mesh);                           ///< its visibility, or its material

void removeMark(osg::Object& object, const char* mark); ///< see ownUserData(): copies of an object share it
/// Gives the object user data of its own.
osg::UserDataContainer& ownUserData(osg::Object& object);

} // namespace osgGpuAnimation
