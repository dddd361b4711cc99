// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdView.h>

#include <osgGpuAnimation/nodes/PoseStage.h>

#include <glm/geometric.hpp>

namespace osgGpuAnimation
{

namespace
{

osg::BoundingBox boxAround(const glm::vec4& sphere)
{
    return {sphere.x - sphere.w, sphere.y - sphere.w, sphere.z - sphere.w,
            sphere.x + sphere.w, sphere.y + sphere.w, sphere.z + sphere.w};
}

} // namespace

std::vector<glm::vec4> CrowdView::planes() const
{
    std::vector<glm::vec4> planes;
    osg::CullingSet& culling = _visitor.getCurrentCullingSet();
    const auto mask = culling.getCullingMask();
    if (mask & osg::CullingSet::VIEW_FRUSTUM_CULLING)
    {
        osg::Polytope& frustum = culling.getFrustum();
        osg::Polytope::ClippingMask bit = 1;
        for (const osg::Plane& plane : frustum.getPlaneList())
        {
            if (frustum.getCurrentMask() & bit) planes.emplace_back(plane[0], plane[1], plane[2], plane[3]);
            bit <<= 1;
        }
    }
    if (mask & osg::CullingSet::SMALL_FEATURE_CULLING)
    {
        // OSG's measure of what is too small, p · v · pixels > radius, has the form of a plane.
        const osg::Vec4 plane = culling.getPixelSizeVector() * -culling.getSmallFeatureCullingPixelSize();
        planes.emplace_back(plane.x(), plane.y(), plane.z(), plane.w());
    }
    return planes;
}

void CrowdView::look(const CrowdInstances& instances, const std::vector<std::uint32_t>& indices)
{
    const osg::Matrix& toEye = *_visitor.getModelViewMatrix();
    const glm::vec4 depthOf(-toEye(0, 2), -toEye(1, 2), -toEye(2, 2), -toEye(3, 2));
    const float scale = glm::length(glm::vec3(depthOf));
    float nearest = 1e30f, farthest = -1e30f;
    glm::vec4 nearestSphere(0.0f, 0.0f, 0.0f, -1.0f), farthestSphere = nearestSphere;
    for (const std::uint32_t index : indices)
    {
        const glm::vec4& sphere = instances.sphere(index);
        const float depth = glm::dot(depthOf, glm::vec4(glm::vec3(sphere), 1.0f));
        const float reach = sphere.w * scale;
        // What lies behind the eye has no say in the near plane.
        if (depth + reach < 0.0f) continue;
        if (depth - reach < nearest) nearest = depth - reach, nearestSphere = sphere;
        if (depth + reach > farthest) farthest = depth + reach, farthestSphere = sphere;
    }
    if (nearestSphere.w < 0.0f) return;
    _depth = 0.5f * (nearest + farthest);
    if (_visitor.getComputeNearFarMode() == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR) return;
    _visitor.updateCalculatedNearFar(toEye, boxAround(nearestSphere));
    _visitor.updateCalculatedNearFar(toEye, boxAround(farthestSphere));
}

void CrowdView::draw(SkinnedGeometry& mesh, const PaletteBinding& binding)
{
    if (!_visitor.validNodeMask(mesh)) return;
    PoseStage::count(_visitor, mesh, binding);
    mesh.addTo(_visitor, _visitor.getModelViewMatrix(), _depth);
}

} // namespace osgGpuAnimation
