// SPDX-License-Identifier: MIT
#pragma once

#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

class SkinnedGeometry;

/// While it lives: what is culled is the mesh, for the instances of the PaletteBinding that the visitor has come
/// through last. The frame takes that down and counts it, and has the mesh drawn in the way it is skinned: see
/// SkinningPlan. Its program is told of its colours.
class SkinningScope
{
public:
    SkinningScope(osgUtil::CullVisitor& visitor, const SkinnedGeometry& mesh);
    ~SkinningScope();
    SkinningScope(const SkinningScope&) = delete;
    SkinningScope& operator=(const SkinningScope&) = delete;

private:
    void push(osg::StateSet& stateSet);

    osgUtil::CullVisitor& _visitor;
    int _pushed = 0; ///< state sets, to be taken back
};

/// Hands the mesh on to be drawn in its SkinningScope, as CullVisitor does once it knows that a drawable is seen.
/// toEye: from where its instances are placed. depth: theirs before the eye.
void addMeshAndDepth(osgUtil::CullVisitor& visitor, SkinnedGeometry& mesh, osg::RefMatrix* toEye, float depth);

} // namespace osgGpuAnimation
