// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/crowd/OutfitLists.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/PosedMeshSource.h>

#include <osg/Group>
#include <osgUtil/CullVisitor>

#include <memory>

namespace osgGpuAnimation
{

class SharedPoses;

/// A crowd as cull sees it.
struct CulledCrowd
{
    osg::Group& node;
    const PosedMeshSource& source; ///< the node
    const CrowdInstances& instances;
    const osg::Group& meshes; ///< to draw: the node, or those of its outfits
    float pixelError;
    std::shared_ptr<const CharacterLevels> levels; ///< null: none
    const SharedPoses* sharedPoses;                ///< null: none
    const OutfitLists* outfits;                    ///< null: none
};

/// Submits the visible instances, draws their meshes and visits the other children.
void cullCrowd(const CulledCrowd& crowd, osgUtil::CullVisitor& visitor);

} // namespace osgGpuAnimation
