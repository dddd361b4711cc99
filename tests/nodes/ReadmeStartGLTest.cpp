// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

// The snippet of the guide application.md on start-up. tests/house/SnippetTest.cpp compares these statements with the
// guide.

namespace osgGpuAnimation
{

using ReadmeStartGLTest = ViewerGLTest;

TEST_F(ReadmeStartGLTest, aSceneIsCompiledOnRealize)
{
    osgViewer::Viewer& viewer = this->viewer();
    const osg::ref_ptr<osg::Node> scene = makeTestCharacter();
    viewer.setSceneData(scene);
    viewer.setRealizeOperation(new osgUtil::GLObjectsOperation(scene));
    viewer.setIncrementalCompileOperation(new osgUtil::IncrementalCompileOperation);
    viewer.realize();
    context().makeCurrent();
    const GlCallTrace trace(state());
    drawAt(0.0);
    EXPECT_EQ(trace.count("glLinkProgram"), 0);
    EXPECT_GT(picture().pixelsDrawn(), 50);
    EXPECT_NO_GL_ERROR();
}

} // namespace osgGpuAnimation
