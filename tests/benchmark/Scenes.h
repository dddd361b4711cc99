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

/// So many characters of one subject in a square, as AnimatedCharacter nodes.
struct CharacterScene
{
    CharacterScene(const Subject& subject, std::size_t count);

    /// Holds everybody where they are.
    void pause();
    void setPixelError(float pixels); ///< everybody's
    /// After a frame, with its state: reads some palettes back. Empty: all is well.
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

/// The same with osgAnimation.
struct ReferenceScene
{
    ReferenceScene(const Subject& subject, ReferenceKit& kit, ReferenceMode mode, std::size_t count);

    /// An update traversal alone, at that simulation time in seconds.
    void update(double time);
    /// Is everybody where the CPU twin has them at that time? Empty: yes.
    std::string check(const Subject& subject, double time);

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<ReferenceCharacter> characters;
};

/// The meshes as they are in bind pose.
osg::ref_ptr<osg::Group> makeUnskinnedScene(const Subject& subject, std::size_t count, Shading shading);

} // namespace osgGpuAnimation::benchmark
