// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <cstdint>

namespace osgGpuAnimation
{

/// A mesh as one instance of a crowd shows it at one moment: what intersectors hit. Never drawn.
class PosedMesh : public osg::Geometry
{
public:
    /// mesh: lends its primitives.
    PosedMesh(const osg::Geometry& mesh, osg::Vec3Array* positions, std::uint64_t instance) : _instance(instance)
    {
        setUseDisplayList(false);
        setUseVertexBufferObjects(false);
        setName(mesh.getName());
        setVertexArray(positions);
        setPrimitiveSetList(mesh.getPrimitiveSetList());
    }

    std::uint64_t instance() const { return _instance; }

protected:
    ~PosedMesh() override = default;

private:
    std::uint64_t _instance;
};

} // namespace osgGpuAnimation
