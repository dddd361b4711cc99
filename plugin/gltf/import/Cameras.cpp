// SPDX-License-Identifier: MIT
#include "gltf/import/Cameras.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/data/UniqueNames.h"
#include "gltf/file/Elements.h"

#include <osg/Math>
#include <osg/ValueObject>

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

osg::ref_ptr<osg::CameraView> makeView(const tinygltf::Camera& camera)
{
    osg::ref_ptr<osg::CameraView> view = new osg::CameraView;
    if (camera.type == "perspective")
    {
        view->setFieldOfView(osg::RadiansToDegrees(camera.perspective.yfov));
        view->setFieldOfViewMode(osg::CameraView::VERTICAL);
        return view;
    }
    view->setFieldOfViewMode(osg::CameraView::UNCONSTRAINED);
    view->setUserValue(orthographicHeightName, 2.0 * std::abs(camera.orthographic.ymag));
    return view;
}

} // namespace

std::vector<ImportedCamera> makeCameras(const tinygltf::Model& model, const NodeTree& tree)
{
    std::vector<ImportedCamera> cameras;
    UniqueNames names;
    const std::vector<bool> areAnimated = animatedObjects(model, PropertyMember::Object::Camera, model.cameras.size());
    for (std::size_t index = 0; index < model.nodes.size(); ++index)
    {
        const tinygltf::Node& node = model.nodes[index];
        if (!tree.drawn[index] || node.camera < 0) continue;
        const tinygltf::Camera& camera = elementOf(model.cameras, node.camera);
        if (camera.type.empty()) continue;
        const std::string& name = camera.name.empty() ? node.name : camera.name;
        cameras.push_back({node.camera, static_cast<int>(index), makeView(camera)});
        if (elementOf(areAnimated, node.camera)) cameras.back().view->setUserValue(cameraMark, node.camera);
        cameras.back().view->setName(names.unique(name.empty() ? "camera " + std::to_string(node.camera) : name));
    }
    return cameras;
}

} // namespace osgGpuAnimation::gltf
