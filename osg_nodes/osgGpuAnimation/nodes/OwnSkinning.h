// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>

namespace osgGpuAnimation
{

class SkinnedGeometry;

/// While it lives, and the mesh is drawn: the program skins by itself, though the mesh was culled as one that is
/// skinned once: in the frame in which so many came into view that there was no room for their vertices.
class OwnSkinning
{
public:
    OwnSkinning(osg::State& state, const SkinnedGeometry& mesh);
    ~OwnSkinning();
    OwnSkinning(const OwnSkinning&) = delete;
    OwnSkinning& operator=(const OwnSkinning&) = delete;

private:
    void apply(const osg::StateSet* stateSet);

    osg::State& _state;
    const SkinnedGeometry& _mesh;
};

} // namespace osgGpuAnimation
