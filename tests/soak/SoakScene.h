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
/// removed, clips change. The caller's random numbers select the changes. Beside them a field of instances keeps its
/// number: in each frame 1 % of them are replaced, moved and redirected, as many of each.
class SoakScene
{
public:
    /// model: contains a character; it is not changed.
    SoakScene(osg::ref_ptr<osg::Node> model, std::size_t fieldCount, std::mt19937& random);

    osg::Group& root() { return *_root; }
    void change(std::mt19937& random);
    /// Removes everything but the field.
    void clear();

private:
    void cloneOne(std::mt19937& random);
    void removeOne(std::mt19937& random);
    void changeClip(AnimationController& controller, std::mt19937& random);
    void changeCrowd(std::mt19937& random);
    void changeField(std::mt19937& random);
    AnimatedCrowd::Instance addTo(AnimatedCrowd& crowd, std::mt19937& random);
    osg::Matrixd randomPlace(std::mt19937& random) const;

    osg::ref_ptr<osg::Node> _model;
    osg::ref_ptr<osg::Group> _root;
    osg::ref_ptr<osg::Group> _clones;
    osg::ref_ptr<AnimatedCrowd> _crowd;
    std::vector<AnimatedCrowd::Instance> _instances;
    osg::ref_ptr<AnimatedCrowd> _field;
    std::vector<AnimatedCrowd::Instance> _fieldInstances;
    double _reach; ///< of places along x and y
};

} // namespace osgGpuAnimation
