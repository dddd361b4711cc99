// SPDX-License-Identifier: MIT
#include "plugin/PosedTriangles.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <osg/BoundingBox>
#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <map>

namespace osgGpuAnimation
{

namespace
{

// Relative to a triangle's side: OSG rounds a cross product of its intersection to float, 6e-8 of the box's size, and
// the smallest triangles have 1/2000 of that size.
constexpr double rounding = 2e-4;

struct Corners
{
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        for (unsigned int corner : {a, b, c})
            vertices.push_back(corner);
    }
    std::vector<unsigned int> vertices;
};

} // namespace

void PosedTriangles::add(const SkinnedGeometry& mesh, const AnimationController& controller,
                         const osg::Matrixd& toWorld, std::uint64_t owner)
{
    std::vector<AffineMatrix> palette;
    Pose::evaluate(controller.set(), controller.instruction(), AffineMatrix(), palette);
    std::vector<glm::dvec3> positions;
    mesh.computePositions(palette, positions);
    osg::TriangleIndexFunctor<Corners> corners;
    mesh.accept(corners);
    for (std::size_t i = 0; i + 2 < corners.vertices.size(); i += 3)
    {
        const unsigned int* vertices = &corners.vertices[i];
        _triangles.push_back({&mesh, &controller.set(), owner, {vertices[0], vertices[1], vertices[2]}});
        for (int corner = 0; corner < 3; ++corner)
        {
            const glm::dvec3& p = positions[vertices[corner]];
            _points.push_back(osg::Vec3d(p.x, p.y, p.z) * toWorld);
        }
    }
}

// Möller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997).
std::vector<PosedTriangles::Hit> PosedTriangles::hits(const osg::Vec3d& start, const osg::Vec3d& end) const
{
    osg::Vec3d direction = end - start;
    const double length = direction.normalize();
    std::vector<Hit> found;
    for (std::size_t i = 0; i < _triangles.size(); ++i)
    {
        const osg::Vec3d e1 = _points[3 * i + 1] - _points[3 * i];
        const osg::Vec3d e2 = _points[3 * i + 2] - _points[3 * i];
        const osg::Vec3d p = direction ^ e2;
        const double determinant = e1 * p;
        if (determinant == 0.0) continue;
        const osg::Vec3d t = start - _points[3 * i];
        const osg::Vec3d q = t ^ e1;
        const double u = (t * p) / determinant, v = (direction * q) / determinant;
        const double distance = (e2 * q) / determinant;
        const double inside = std::min({u, v, 1.0 - u - v});
        if (!(inside >= -rounding) || distance < 0.0 || distance > length) continue;
        const bool isSeenFlat = std::abs(determinant) < 1e-3 * e1.length() * e2.length();
        const double shares[3] = {1.0 - u - v, u, v};
        found.push_back(
            {distance, inside > rounding && !isSeenFlat, _triangles[i].owner, heaviest(_triangles[i], shares)});
    }
    return found;
}

std::set<int> PosedTriangles::heaviest(const Triangle& triangle, const double shares[3])
{
    std::map<int, double> weights;
    double most = 0.0;
    for (int corner = 0; corner < 3; ++corner)
    {
        const unsigned int vertex = triangle.vertices[corner];
        const auto add = [&](std::size_t entry, double weight)
        {
            double& sum = weights[triangle.set->palette()[entry].joint];
            sum += shares[corner] * weight;
            most = std::max(most, sum);
        };
        if (triangle.mesh->getRigidEntry() >= 0) add(static_cast<std::size_t>(triangle.mesh->getRigidEntry()), 1.0);
        for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets && triangle.mesh->getEntries(i); ++i)
            for (int k = 0; k < 4; ++k)
            {
                const double weight = static_cast<double>((*triangle.mesh->getWeights(i))[vertex][k]);
                if (weight != 0.0) add((*triangle.mesh->getEntries(i))[vertex][k], weight);
            }
    }
    std::set<int> joints;
    for (const auto& [joint, weight] : weights)
        if (weight >= most - 1e-2) joints.insert(joint);
    return joints;
}

double PosedTriangles::size() const
{
    osg::BoundingBoxd box;
    for (const osg::Vec3d& point : _points)
        box.expandBy(point);
    return (box._max - box._min).length();
}

} // namespace osgGpuAnimation
