// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

#include <random>
#include <vector>

namespace osgGpuAnimation
{

/// A scene that changes between frames: characters are cloned from a model and removed, crowd instances are added and
/// removed, clips change. The caller's random numbers select the changes.
class SoakScene
{
public:
    /// model: contains a character; it is not changed.
    explicit SoakScene(osg::ref_ptr<osg::Node> model);

    osg::Group& root() { return *_root; }
    void change(std::mt19937& random);
    /// Removes everything.
    void clear();

private:
    void cloneOne(std::mt19937& random);
    void removeOne(std::mt19937& random);
    void changeClip(AnimationController& controller, std::mt19937& random);
    void changeCrowd(std::mt19937& random);
    osg::Matrixd randomPlace(std::mt19937& random) const;

    osg::ref_ptr<osg::Node> _model;
    osg::ref_ptr<osg::Group> _root;
    osg::ref_ptr<osg::Group> _clones;
    osg::ref_ptr<AnimatedCrowd> _crowd;
    std::vector<AnimatedCrowd::Instance> _instances;
};

} // namespace osgGpuAnimation
