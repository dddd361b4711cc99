// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace osgGpuAnimation
{

/// How far a point is from some planes: the weighted mean of the squares of its distances. (Garland and Heckbert,
/// Surface Simplification Using Quadric Error Metrics, 1997.)
struct PlaneQuadric
{
    double weight = 0.0; ///< of all planes together

    /// normal: of length 1.
    void add(const glm::dvec3& normal, const glm::dvec3& point, double planeWeight)
    {
        const double distance = -glm::dot(normal, point);
        weight += planeWeight;
        _square += planeWeight * normal * normal;
        _mixed += planeWeight * glm::dvec3(normal.x * normal.y, normal.y * normal.z, normal.z * normal.x);
        _linear += planeWeight * distance * normal;
        _constant += planeWeight * distance * distance;
    }

    PlaneQuadric& operator+=(const PlaneQuadric& other)
    {
        weight += other.weight;
        _square += other._square;
        _mixed += other._mixed;
        _linear += other._linear;
        _constant += other._constant;
        return *this;
    }

    double at(const glm::dvec3& p) const
    {
        if (!(weight > 0.0)) return 0.0;
        const glm::dvec3 products(p.x * p.y, p.y * p.z, p.z * p.x);
        const double sum =
            glm::dot(_square, p * p) + 2.0 * (glm::dot(_mixed, products) + glm::dot(_linear, p)) + _constant;
        return sum > 0.0 ? sum / weight : 0.0;
    }

private:
    glm::dvec3 _square{0.0}; ///< xx, yy, zz of the sum of n nᵀ
    glm::dvec3 _mixed{0.0};  ///< xy, yz, zx
    glm::dvec3 _linear{0.0};
    double _constant = 0.0;
};

} // namespace osgGpuAnimation
