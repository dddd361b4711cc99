// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <memory>

namespace osgGpuAnimation
{

class CharacterLevels;
class CrowdInstances;

/// What the kit's own plugins and tests need of an AnimatedCrowd, and applications do not.
struct CrowdDetail
{
    /// Gives a set to a crowd without one and computes the bounds from the present meshes. Errors: set is null; the
    /// crowd has instances or a set.
    static Result<void> setAnimationSet(AnimatedCrowd& crowd, std::shared_ptr<const AnimationSet> set);

    /// The arrays of all instances.
    static const CrowdInstances& instances(const AnimatedCrowd& crowd) { return *crowd._instances; }

    /// The meshes that it draws: its own, or those of its outfits.
    static const osg::Group& drawnMeshes(const AnimatedCrowd& crowd) { return crowd._meshes.drawn(); }

    /// The levels of detail of the character as a whole. Null: there was no pixel error yet, or they are being made.
    /// setPixelError() requests them unless those that are set match the meshes; a pixel error of 0 keeps them.
    static const std::shared_ptr<const CharacterLevels>& levels(const AnimatedCrowd& crowd)
    {
        return crowd._meshes._levels;
    }

    /// Sets what setPixelError() would request; call it before.
    static void setLevels(AnimatedCrowd& crowd, std::shared_ptr<const CharacterLevels> levels)
    {
        crowd._meshes._levels = std::move(levels);
        crowd._meshes.showLevels();
    }
};

} // namespace osgGpuAnimation
