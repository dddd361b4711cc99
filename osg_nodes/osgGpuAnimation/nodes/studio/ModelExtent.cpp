// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/studio/ModelExtent.h>

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/ComputeBoundsVisitor>
#include <osg/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgGpuAnimation
{

namespace
{

/// Of a mesh that does not move; a larger one counts by the corners of its box.
constexpr std::size_t maxVertexCount = 100000;
/// Of each outer instance of a crowd, whose extent depends little on them.
constexpr int maxCrowdPoseCount = 3;

/// The outermost instances in eight horizontal directions.
std::set<std::size_t> outerInstances(const AnimatedCrowd& crowd)
{
    std::set<std::size_t> outer;
    for (int x = -1; x <= 1 && crowd.getNumInstances() > 0; ++x)
        for (int y = -1; y <= 1; ++y)
        {
            if (x == 0 && y == 0) continue;
            const auto along = [&](std::size_t index)
            {
                return x * CrowdDetail::instances(crowd).position(index).x() +
                       y * CrowdDetail::instances(crowd).position(index).y();
            };
            std::size_t max = 0;
            for (std::size_t index = 1; index < crowd.getNumInstances(); ++index)
                if (along(index) > along(max)) max = index;
            outer.insert(max);
        }
    return outer;
}

class PointCollector : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    /// poseCount: of each character, spread evenly over its clip from the present time on; crowds have fewer.
    explicit PointCollector(int poseCount)
        : SceneVisitor(Shared::EachPath, TRAVERSE_ACTIVE_CHILDREN), _poseCount(poseCount)
    {
    }

    void apply(osg::Transform& transform) override
    {
        if (auto* character = dynamic_cast<AnimatedCharacter*>(&transform))
            addPoses(*character, character->getController(), toAffine(character->getFileToNode()), _poseCount);
        else if (auto* crowd = dynamic_cast<AnimatedCrowd*>(&transform))
            for (const std::size_t index : outerInstances(*crowd))
                addPoses(*crowd, CrowdDetail::instances(*crowd).controllerCopy(index),
                         CrowdDetail::instances(*crowd).rootMatrix(index), std::min(_poseCount, maxCrowdPoseCount));
        traverse(transform);
    }

    void apply(osg::Geometry& geometry) override
    {
        const osg::Array* vertices = geometry.getVertexArray();
        if (dynamic_cast<const osg::Vec3Array*>(vertices) && vertices->getNumElements() <= maxVertexCount)
            add(geometry);
        else
            apply(static_cast<osg::Drawable&>(geometry));
    }

    void apply(osg::Drawable& drawable) override
    {
        if (dynamic_cast<SkinnedGeometry*>(&drawable)) return;
        const osg::Matrixd toGroup = osg::computeLocalToWorld(getNodePath());
        const osg::BoundingBox& box = drawable.getBoundingBox();
        for (unsigned int corner = 0; corner < 8 && box.valid(); ++corner)
            points.push_back(osg::Vec3d(box.corner(corner)) * toGroup);
    }

    std::vector<osg::Vec3d> points;

private:
    void addPoses(osg::Group& node, AnimationController controller, const AffineMatrix& rootToNode, int poseCount)
    {
        PosedMeshes posed;
        const double start = controller.time(), duration = controller.duration();
        for (int pose = 0; pose < poseCount && (pose == 0 || duration > 0.0); ++pose)
        {
            if (pose > 0) controller.seek(std::fmod(start + duration * pose / poseCount, duration));
            const PoseInstruction instruction = controller.instruction();
            forEachMesh(node, [&](const SkinnedGeometry& mesh)
                        { add(*posed.of(mesh, controller.sharedSet(), instruction, rootToNode)); });
        }
    }

    void add(const osg::Geometry& geometry)
    {
        const osg::Matrixd toGroup = osg::computeLocalToWorld(getNodePath());
        if (const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray()))
            for (const osg::Vec3& vertex : *vertices)
                points.push_back(osg::Vec3d(vertex) * toGroup);
    }

    int _poseCount;
};

/// OSG's visitor of bounds, with the guard of SceneVisitor.
class Bounds : public osg::ComputeBoundsVisitor
{
public:
    using osg::ComputeBoundsVisitor::apply;
    void apply(osg::Node& node) override
    {
        if (_guard.enter(node, getNodePath().size())) traverse(node);
    }
    void apply(osg::Transform& transform) override
    {
        if (_guard.enter(transform, getNodePath().size())) osg::ComputeBoundsVisitor::apply(transform);
    }

private:
    SceneGuard _guard{SceneGuard::Shared::EachPath};
};

} // namespace

osg::BoundingBoxd extentOf(osg::Group& group)
{
    Bounds visitor;
    group.osg::Group::traverse(visitor);
    return osg::BoundingBoxd(visitor.getBoundingBox());
}

std::vector<osg::Vec3d> pointsOf(osg::Group& group, int poseCount)
{
    PointCollector collector(poseCount);
    group.osg::Group::traverse(collector);
    return std::move(collector.points);
}

} // namespace osgGpuAnimation
