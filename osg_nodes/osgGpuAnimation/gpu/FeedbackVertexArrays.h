// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/observer_ptr>
#include <osg/State>

#include <vector>

namespace osgGpuAnimation
{

/// The vertex array objects of feedback passes. OpenGL contexts that share their objects (one OSG context number) share
/// all but these, so each osg::State has its own.
class FeedbackVertexArrays
{
public:
    struct Names
    {
        osg::observer_ptr<osg::State> state;
        GLuint pose = 0;  ///< with the attributes of the pose pass
        GLuint empty = 0; ///< without any
    };

    explicit FeedbackVertexArrays(osg::GLExtensions& gl) : _gl(&gl) {}

    /// The state's context is current.
    const Names& of(osg::State& state);

    /// Where several contexts have some, only the last one's end can free them: the others go with their contexts.
    void release();
    void discard() { _names.clear(); }

private:
    osg::GLExtensions* _gl;
    std::vector<Names> _names; ///< hardly ever more than one
};

} // namespace osgGpuAnimation
