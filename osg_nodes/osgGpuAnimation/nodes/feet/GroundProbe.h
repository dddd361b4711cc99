// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>
#include <osg/Vec3d>

#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// A place on the ground, in world space.
struct GroundPoint
{
    osg::Vec3d place;
    osg::Vec3d normal; ///< of length 1, its z above 0

    /// The height of the tangent plane at another place.
    double heightAt(const osg::Vec3d& at) const
    {
        return place.z() - (normal.x() * (at.x() - place.x()) + normal.y() * (at.y() - place.y())) / normal.z();
    }
};

/// Finds the ground below or above places by OSG's intersectors. Characters, crowds and cameras with a view of their
/// own are no ground, unless the ground node itself is one. Surfaces steeper than 80 degrees count as level.
class GroundProbe
{
public:
    /// A vertical line in world space.
    struct Line
    {
        osg::Vec3d top;
        double length; ///< downwards, above 0
    };

    GroundProbe();
    ~GroundProbe();

    /// The highest ground on each line, in one traversal; empty: none, or not finite. outPoints: one per line.
    void highest(osg::Node& ground, osg::Node::NodeMask traversalMask, const std::vector<Line>& lines,
                 std::vector<std::optional<GroundPoint>>& outPoints);
    /// The ground nearest to a place, above or below it; empty: none.
    std::optional<GroundPoint> nearest(osg::Node& ground, osg::Node::NodeMask traversalMask, const osg::Vec3d& place);

private:
    class Visitor;

    osg::ref_ptr<Visitor> _visitor;
};

} // namespace osgGpuAnimation
