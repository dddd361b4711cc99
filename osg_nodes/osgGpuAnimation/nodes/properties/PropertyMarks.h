// SPDX-License-Identifier: MIT
#pragma once

#include <osg/CameraView>
#include <osg/Drawable>
#include <osg/LightSource>
#include <osg/StateSet>
#include <osg/UserDataContainer>

#include <optional>
#include <vector>

namespace osgGpuAnimation
{

// The marks of the import: user values, so that OSG's own serializers keep them. The numbers are the file's.
void markMaterial(osg::StateSet& stateSet, int material); ///< a material with animated properties
void markLight(osg::LightSource& source, int light);      ///< an animated light, a PunctualLight
void markCamera(osg::CameraView& view, int camera);       ///< an animated camera
/// A drawable or a light. nodes: it is visible while all these nodes are.
void markVisibility(osg::Node& node, const std::vector<int>& nodes);

// What is marked, empty if it is not.
std::optional<int> markOf(const osg::StateSet& stateSet);  ///< the material
std::optional<int> markOf(const osg::LightSource& source); ///< the light
std::optional<int> markOf(const osg::CameraView& view);    ///< the camera
std::vector<int> visibilityOf(const osg::Object& object);  ///< the nodes of markVisibility()
bool isMeshMarked(const osg::Drawable& mesh);              ///< its visibility, or its material

void removeMark(osg::StateSet& stateSet);
/// Gives the object user data of its own, without visibility: copies of an object share it.
void removeVisibility(osg::Object& object);
/// Gives the object user data of its own.
osg::UserDataContainer& ownUserData(osg::Object& object);

} // namespace osgGpuAnimation
