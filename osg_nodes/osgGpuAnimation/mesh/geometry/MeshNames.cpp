// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <osg/ValueObject>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

const char* const nodeNameKey = "osgGpuAnimation.node";

} // namespace

void setNodeName(osg::Object& mesh, const std::string& name)
{
    if (!name.empty() && name != mesh.getName()) mesh.setUserValue(nodeNameKey, name);
}

std::string nodeNameOf(const osg::Object& mesh)
{
    std::string name;
    return mesh.getUserValue(nodeNameKey, name) ? name : mesh.getName();
}

Result<std::vector<SkinnedGeometry*>> meshesNamed(const osg::Group& group, const std::string& name)
{
    std::vector<SkinnedGeometry*> ofNode, ofMesh;
    std::vector<std::string> names;
    const auto sort = [&](const SkinnedGeometry& mesh)
    {
        const std::string nodeName = nodeNameOf(mesh);
        if (nodeName == name) ofNode.push_back(const_cast<SkinnedGeometry*>(&mesh));
        if (mesh.getName() == name) ofMesh.push_back(const_cast<SkinnedGeometry*>(&mesh));
        if (std::find(names.begin(), names.end(), nodeName) == names.end()) names.push_back(nodeName);
    };
    forEachMesh(group, sort);
    if (!ofNode.empty()) return ofNode;
    if (!ofMesh.empty()) return ofMesh;
    return Error{"there is no mesh \"" + name + "\"; the meshes are " +
                 quotedNames(names, [](const std::string& known) { return known; })};
}

} // namespace osgGpuAnimation
