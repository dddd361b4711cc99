// SPDX-License-Identifier: MIT
#pragma once

#include "support/Picture.h"

#include <osg/GLExtensions>

namespace osgGpuAnimation
{

/// Counts the primitives that a camera draws in a frame, without those of earlier cameras (poses, shadow maps).
///
///     const osg::ref_ptr<PrimitiveCount> count = new PrimitiveCount;
///     count->attach(*viewer().getCamera(), picture()); // in the place of its initial and final draw callbacks
class PrimitiveCount : public osg::Referenced
{
public:
    /// Replaces the camera's draw callbacks; the picture is taken as before.
    void attach(osg::Camera& camera, const Picture& picture)
    {
        camera.setInitialDrawCallback(new Begin(*this));
        camera.setFinalDrawCallback(new End(*this, picture));
    }

    GLuint primitives() const { return _primitives; } ///< of the last frame

private:
    struct Begin : osg::Camera::DrawCallback
    {
        explicit Begin(PrimitiveCount& count) : count(&count) {}
        void operator()(osg::RenderInfo& renderInfo) const override
        {
            osg::GLExtensions& gl = *renderInfo.getState()->get<osg::GLExtensions>();
            gl.glGenQueries(1, &count->_query);
            gl.glBeginQuery(GL_PRIMITIVES_GENERATED, count->_query);
        }
        osg::ref_ptr<PrimitiveCount> count;
    };
    struct End : osg::Camera::DrawCallback
    {
        End(PrimitiveCount& count, const Picture& picture) : count(&count), picture(&picture) {}
        void operator()(osg::RenderInfo& renderInfo) const override
        {
            osg::GLExtensions& gl = *renderInfo.getState()->get<osg::GLExtensions>();
            gl.glEndQuery(GL_PRIMITIVES_GENERATED);
            gl.glGetQueryObjectuiv(count->_query, GL_QUERY_RESULT, &count->_primitives);
            gl.glDeleteQueries(1, &count->_query);
            (*picture)(renderInfo);
        }
        osg::ref_ptr<PrimitiveCount> count;
        osg::ref_ptr<const Picture> picture;
    };

    GLuint _query = 0;
    GLuint _primitives = 0;
};

} // namespace osgGpuAnimation
