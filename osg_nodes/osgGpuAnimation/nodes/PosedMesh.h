// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <cstdint>
#include <optional>

namespace osgGpuAnimation
{

/// A mesh as a character, or one instance of a crowd, shows it at one moment: what intersectors hit. Never drawn.
/// It lends the mesh's primitives, texture coordinates and state, so that what is asked of a hit's drawable is there.
class PosedMesh : public osg::Geometry
{
public:
    /// positions: one a vertex of the mesh. instance: where it is a crowd's.
    PosedMesh(const SkinnedGeometry& mesh, osg::Vec3Array* positions,
              std::optional<std::uint64_t> instance = std::nullopt);

    const SkinnedGeometry& mesh() const { return *_mesh; }
    std::optional<std::uint64_t> instance() const { return _instance; }

protected:
    ~PosedMesh() override = default;

private:
    osg::ref_ptr<const SkinnedGeometry> _mesh;
    std::optional<std::uint64_t> _instance;
};

} // namespace osgGpuAnimation
