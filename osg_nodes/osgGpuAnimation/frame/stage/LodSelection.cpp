// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>

#include <osg/Transform>

#include <algorithm>

namespace osgGpuAnimation
{

std::string LodRange::describePixelErrors()
{
    return "a number of pixels from 0 to " + std::to_string(maxPixelError);
}

LodRange::LodRange(const osg::Group& meshes, const AnimationSet& set, std::shared_ptr<const CharacterLevels> merged)
    : _merged(merged && merged->isOf(meshes, set) ? std::move(merged) : nullptr)
{
    const auto add = [&](const auto& levels)
    {
        if (levels.finest() == LodLevels::allTriangles) return;
        _finest = std::min(_finest, levels.finest());
        _coarsest = std::max(_coarsest, levels.coarsest());
    };
    if (_merged) add(*_merged);
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    std::shared_ptr<const LodLevels> levels = MeshDetail::findLevels(mesh);
                    if (!levels) return;
                    add(*levels);
                    _ofMeshes.emplace_back(&mesh, std::move(levels));
                });
}

double LodRange::foundError(int level) const
{
    if (level == LodLevels::allTriangles) return 0.0;
    double max = _merged ? _merged->foundError(level) : 0.0;
    for (const auto& [mesh, levels] : _ofMeshes)
        if (!_merged || !_merged->isMerged(*mesh, level)) max = std::max(max, levels->foundError(level));
    return max;
}

namespace
{

bool isAbsolute(const osg::Node* node)
{
    const auto* camera = dynamic_cast<const osg::Camera*>(node);
    return camera && camera->getReferenceFrame() != osg::Transform::RELATIVE_RF;
}

} // namespace

osg::Vec4 LodView::pixelSizeVector(osgUtil::CullVisitor& visitor)
{
    if (visitor.getProjectionMatrix() != _projection || visitor.getCurrentCamera() != _culled) find(visitor);
    if (!_eye) return visitor.getCurrentCullingSet().getPixelSizeVector();
    return osg::CullingSet::computePixelSizeVector(*_viewport, _eye->getProjectionMatrix(),
                                                   *visitor.getModelViewMatrix() * _toEye);
}

void LodView::find(osgUtil::CullVisitor& visitor)
{
    _projection = visitor.getProjectionMatrix();
    _culled = visitor.getCurrentCamera();
    _eye = nullptr;
    if (!_culled || !DepthPass::isOf(*_culled) || !isAbsolute(_culled)) return;
    const osg::NodePath& path = visitor.getNodePath();
    const auto place = std::find(path.rbegin(), path.rend(), _culled);
    if (place == path.rend()) return;
    // The nodes above the shadow map's camera define its world space and contain the camera that shows it.
    const osg::NodePath above(path.begin(), std::prev(place.base()));
    const auto nested = std::find_if(above.rbegin(), above.rend(), isAbsolute);
    const osg::Camera* root = visitor.getRenderStage()->getCamera();
    const osg::Camera* eye = nested == above.rend() ? root : (*nested)->asCamera();
    _viewport = eye && eye->getViewport() ? eye->getViewport() : visitor.getRenderStage()->getViewport();
    if (!root || !_viewport) return;
    _eye = eye;
    _toEye = _culled->getInverseViewMatrix() * osg::computeLocalToEye(root->getViewMatrix(), above, false);
}

LodScale::LodScale(osgUtil::CullVisitor& visitor, LodView& view, float pixelError, const LodRange& range)
    : _range(range)
{
    if (!(pixelError > 0.0f)) return;
    const auto measure = [pixelError](const osg::Vec4& halfPixel)
    {
        const glm::vec4 errorAt =
            2.0f * pixelError * glm::vec4(halfPixel.x(), halfPixel.y(), halfPixel.z(), halfPixel.w());
        return Measure{errorAt, glm::length(glm::vec3(errorAt))};
    };
    _seen = measure(view.pixelSizeVector(visitor));
    _own = measure(visitor.getCurrentCullingSet().getPixelSizeVector());
}

} // namespace osgGpuAnimation
