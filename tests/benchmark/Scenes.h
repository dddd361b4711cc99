// SPDX-License-Identifier: MIT
#pragma once

#include "ReferenceKit.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// Many characters of one subject in a square, as AnimatedCharacter nodes.
struct CharacterScene
{
    CharacterScene(const Subject& subject, std::size_t count);

    /// Pauses all characters.
    void pause();
    Result<void> setPixelError(float pixels); ///< of all characters
    /// Compares some palettes with the CPU twin's after a frame, with its GL state. Empty if they agree.
    std::string check(osg::State& state) const;

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<osg::ref_ptr<AnimatedCharacter>> characters;
};

/// The same characters, placements and clips in one AnimatedCrowd.
struct CrowdScene
{
    CrowdScene(const Subject& subject, std::size_t count);

    osg::ref_ptr<AnimatedCrowd> root;
};

/// The same characters with osgAnimation.
struct ReferenceScene
{
    ReferenceScene(const Subject& subject, ReferenceKit& kit, ReferenceMode mode, std::size_t count);

    /// Runs only the update traversal, at that simulation time in seconds.
    void update(double time);
    /// Compares some characters with the CPU twin's at that time. Empty if they agree.
    std::string check(const Subject& subject, double time);

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<ReferenceCharacter> characters;
};

/// The meshes in bind pose, without skinning.
osg::ref_ptr<osg::Group> makeUnskinnedScene(const Subject& subject, std::size_t count, Shading shading);

} // namespace osgGpuAnimation::benchmark
