// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>

#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <osg/ValueObject>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

const char* const meshNameKey = "osgGpuAnimation.mesh";

} // namespace

void setMeshName(osg::Object& drawable, const std::string& name)
{
    if (!name.empty() && name != drawable.getName()) drawable.setUserValue(meshNameKey, name);
}

std::string meshNameOf(const osg::Object& drawable)
{
    std::string name;
    return drawable.getUserValue(meshNameKey, name) ? name : drawable.getName();
}

Result<std::vector<SkinnedGeometry*>> meshesNamed(const osg::Group& group, const std::string& name)
{
    std::vector<SkinnedGeometry*> ofNode, ofMesh;
    std::vector<std::string> names;
    const auto sort = [&](const SkinnedGeometry& mesh)
    {
        if (mesh.getName() == name) ofNode.push_back(const_cast<SkinnedGeometry*>(&mesh));
        if (meshNameOf(mesh) == name) ofMesh.push_back(const_cast<SkinnedGeometry*>(&mesh));
        if (std::find(names.begin(), names.end(), mesh.getName()) == names.end()) names.push_back(mesh.getName());
    };
    forEachMesh(group, sort);
    if (!ofNode.empty()) return ofNode;
    if (!ofMesh.empty()) return ofMesh;
    return Error{"there is no mesh \"" + name + "\"; the meshes are " + quotedNames(names)};
}

std::vector<std::string> variantNamesIn(const osg::Group& group)
{
    std::vector<std::string> names = variantNamesOf(group);
    const auto addNames = [&](const SkinnedGeometry& mesh)
    {
        for (const std::string& name : variantNamesOf(mesh))
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    forEachMesh(group, addNames);
    return names;
}

} // namespace osgGpuAnimation
