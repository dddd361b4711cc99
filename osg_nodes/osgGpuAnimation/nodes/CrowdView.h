// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/CrowdInstances.h>
#include <osgGpuAnimation/nodes/PaletteBinding.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgUtil/CullVisitor>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// A crowd as one camera sees it while it is culled: what is in view, how far away, and how meshes are handed on to be
/// drawn. Lives as long as the crowd's own traversal, in its space.
class CrowdView
{
public:
    explicit CrowdView(osgUtil::CullVisitor& visitor) : _visitor(visitor) {}

    /// What an instance must reach the inner side of: n · p + d >= 0. The view's, and one for what is too small.
    std::vector<glm::vec4> planes() const;
    /// Tells the camera's near and far planes of them. indices: those that are seen, at least one.
    void look(const CrowdInstances& instances, const std::vector<std::uint32_t>& indices);
    /// Adds the mesh to the visitor's render bin, at the depth of those looked at, where the visitor's mask allows it.
    void draw(SkinnedGeometry& mesh, const PaletteBinding& binding);

private:
    osgUtil::CullVisitor& _visitor;
    float _depth = 0.0f; ///< before the eye
};

} // namespace osgGpuAnimation
