// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Matrixd>

#include <cstdint>
#include <set>
#include <vector>

namespace osgGpuAnimation
{

/// The triangles of characters in the world, posed by the CPU twin and never rounded to float, with their own
/// intersection test: the reference for picking.
class PosedTriangles
{
public:
    struct Hit
    {
        double distance;
        bool isSure;          ///< further from the triangle's edges than rounding reaches
        std::uint64_t owner;  ///< as given to add()
        std::set<int> joints; ///< the heaviest one at the point, and any that weighs nearly as much
    };

    /// mesh: as the controller poses it. toWorld: from the file's axes.
    void add(const SkinnedGeometry& mesh, const AnimationController& controller, const osg::Matrixd& toWorld,
             std::uint64_t owner = 0);

    /// All that the segment meets, in no order; also what it misses by no more than rounding.
    std::vector<Hit> hits(const osg::Vec3d& start, const osg::Vec3d& end) const;

    const std::vector<osg::Vec3d>& points() const { return _points; } ///< three a triangle
    double size() const;                                              ///< the diagonal of the box around all

private:
    struct Triangle
    {
        const SkinnedGeometry* mesh;
        const AnimationSet* set;
        std::uint64_t owner;
        unsigned int vertices[3];
    };

    static std::set<int> heaviest(const Triangle& triangle, const double shares[3]);

    std::vector<osg::Vec3d> _points;
    std::vector<Triangle> _triangles;
};

} // namespace osgGpuAnimation
