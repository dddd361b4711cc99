// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/PaletteBinding.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Drawable>

#include <vector>

namespace osgGpuAnimation
{

/// Stands in a cull's result for the instances that draws of many show beyond their first: a camera's statistics
/// (osgViewer's StatsHandler) ask each drawable that was handed on for its primitives, and a mesh tells them once. It
/// draws nothing, and is no drawable more in statistics. The PoseStage has it while such statistics are collected.
class DrawnInstances : public osg::Drawable
{
public:
    DrawnInstances();

    /// At the beginning of a cull traversal.
    void clear() { _draws.clear(); }
    /// The mesh is drawn for the instances of the binding, which may come later.
    void add(const SkinnedGeometry& mesh, const PaletteBinding& binding) { _draws.push_back({&mesh, &binding}); }

    using osg::Drawable::accept;
    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override;
    void drawImplementation(osg::RenderInfo&) const override {}

protected:
    ~DrawnInstances() override = default;

private:
    struct Draw
    {
        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const PaletteBinding> binding;
    };

    std::vector<Draw> _draws;
};

} // namespace osgGpuAnimation
