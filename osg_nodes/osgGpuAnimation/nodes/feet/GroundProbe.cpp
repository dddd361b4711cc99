// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/GroundProbe.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>

#include <osg/Camera>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

using Intersector = osgUtil::LineSegmentIntersector;

constexpr double steepest = 0.17; ///< the least z of a normal: 80 degrees

bool isFinite(const osg::Vec3d& vector)
{
    return std::isfinite(vector.x()) && std::isfinite(vector.y()) && std::isfinite(vector.z());
}

std::optional<GroundPoint> pointOf(const Intersector::Intersection& hit, const osg::Matrixd& aboveToWorld)
{
    const osg::Matrixd toWorld = (hit.matrix.valid() ? osg::Matrixd(*hit.matrix) : osg::Matrixd()) * aboveToWorld;
    GroundPoint point{
        hit.localIntersectionPoint * toWorld,
        osg::Matrixd::transform3x3(osg::Matrixd::inverse(toWorld), osg::Vec3d(hit.localIntersectionNormal))};
    point.normal.normalize();
    if (point.normal.z() < 0.0) point.normal = -point.normal;
    if (!(point.normal.z() > steepest)) point.normal.set(0.0, 0.0, 1.0);
    return isFinite(point.place) && isFinite(point.normal) ? std::optional<GroundPoint>(point) : std::nullopt;
}

} // namespace

class GroundProbe::Visitor : public osgUtil::IntersectionVisitor
{
public:
    /// One intersector per line; those of earlier calls are used again.
    void intersect(osg::Node& ground, osg::Node::NodeMask traversalMask, const std::vector<Line>& lines,
                   Intersector::IntersectionLimit limit)
    {
        _ground = &ground;
        _aboveToWorld = toWorld(ground, false);
        const osg::Matrixd fromWorld = osg::Matrixd::inverse(_aboveToWorld);
        const osg::ref_ptr<osgUtil::IntersectorGroup> group = new osgUtil::IntersectorGroup;
        while (_lines.size() < lines.size())
            _lines.push_back(new Intersector(osg::Vec3d(), osg::Vec3d()));
        for (std::size_t i = 0; i < lines.size(); ++i)
        {
            _lines[i]->reset();
            _lines[i]->setIntersectionLimit(limit);
            _lines[i]->setStart(lines[i].top * fromWorld);
            _lines[i]->setEnd((lines[i].top - osg::Vec3d(0.0, 0.0, lines[i].length)) * fromWorld);
            group->addIntersector(_lines[i]);
        }
        setIntersector(group);
        setTraversalMask(traversalMask);
        ground.accept(*this);
        setIntersector(nullptr);
    }
    /// Hits own drawables.
    void forgetHits()
    {
        for (const osg::ref_ptr<Intersector>& line : _lines)
            line->reset();
    }

    const Intersector::Intersections& hits(std::size_t line) const { return _lines[line]->getIntersections(); }
    const osg::Matrixd& aboveToWorld() const { return _aboveToWorld; } ///< of the ground node

    using osgUtil::IntersectionVisitor::apply;
    void apply(osg::Transform& transform) override
    {
        const bool isCharacter =
            dynamic_cast<AnimatedCharacter*>(&transform) || dynamic_cast<AnimatedCrowd*>(&transform);
        if (!isCharacter || &transform == _ground) osgUtil::IntersectionVisitor::apply(transform);
    }
    void apply(osg::Camera& camera) override
    {
        if (camera.getReferenceFrame() == osg::Transform::RELATIVE_RF) osgUtil::IntersectionVisitor::apply(camera);
    }

private:
    const osg::Node* _ground = nullptr;
    osg::Matrixd _aboveToWorld;
    std::vector<osg::ref_ptr<Intersector>> _lines;
};

GroundProbe::GroundProbe() : _visitor(new Visitor) {}

GroundProbe::~GroundProbe() = default;

void GroundProbe::highest(osg::Node& ground, osg::Node::NodeMask traversalMask, const std::vector<Line>& lines,
                          std::vector<std::optional<GroundPoint>>& outPoints)
{
    _visitor->intersect(ground, traversalMask, lines, Intersector::LIMIT_NEAREST);
    outPoints.assign(lines.size(), std::nullopt);
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (!_visitor->hits(i).empty()) outPoints[i] = pointOf(*_visitor->hits(i).begin(), _visitor->aboveToWorld());
    _visitor->forgetHits();
}

std::optional<GroundPoint> GroundProbe::nearest(osg::Node& ground, osg::Node::NodeMask traversalMask,
                                                const osg::Vec3d& place)
{
    const osg::BoundingSphere& bound = ground.getBound();
    const osg::Matrixd aboveToWorld = toWorld(ground, false);
    const osg::Vec3d center = osg::Vec3d(bound.center()) * aboveToWorld;
    if (!bound.valid() || !isFinite(center) || !isFinite(place)) return std::nullopt;
    const osg::Vec3d scale = aboveToWorld.getScale();
    const double reach = static_cast<double>(bound.radius()) * std::max({scale.x(), scale.y(), scale.z()}) * 1.01;
    if (!std::isfinite(reach) || !(reach > 0.0)) return std::nullopt;
    const Line line{{place.x(), place.y(), center.z() + reach}, 2.0 * reach};
    _visitor->intersect(ground, traversalMask, {line}, Intersector::NO_LIMIT);
    std::optional<GroundPoint> nearest;
    for (const Intersector::Intersection& hit : _visitor->hits(0))
        if (const auto point = pointOf(hit, _visitor->aboveToWorld()))
            if (!nearest || std::abs(point->place.z() - place.z()) < std::abs(nearest->place.z() - place.z()))
                nearest = point;
    _visitor->forgetHits();
    return nearest;
}

} // namespace osgGpuAnimation
