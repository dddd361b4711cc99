// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/PropMeshes.h>

#include <osgGpuAnimation/nodes/detail/RigidMeshes.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <algorithm>

namespace osgGpuAnimation
{

Result<std::vector<osg::ref_ptr<SkinnedGeometry>>> propMeshes(const Outfit::Prop& prop, const AnimationSet& set)
{
    const std::string subject = "the prop on joint \"" + prop.joint + "\": ";
    if (!prop.node) return Error{subject + "it has no node"};
    const Result<std::size_t> joint = set.skeleton().jointNamed(prop.joint);
    if (!joint) return Error{subject + joint.error().message};
    const auto follows = [&](const PaletteEntry& entry) { return entry.joint == static_cast<int>(joint.value()); };
    const auto entry = std::find_if(set.palette().begin(), set.palette().end(), follows);
    if (entry == set.palette().end()) return Error{subject + "it moves no mesh of the crowd"};
    if (const Result<AffineMatrix> checked = toRootMatrix(prop.toJoint, "the transform to the joint", true); !checked)
        return Error{subject + checked.error().message};
    const osg::Matrixd toEntry = prop.toJoint * osg::Matrixd::inverse(toOsg(entry->inverseBind));
    if (!toEntry.valid()) return Error{subject + "its inverse bind matrix has no inverse"};
    RigidMeshes made = RigidMeshes::of(*prop.node, static_cast<unsigned short>(entry - set.palette().begin()), toEntry);
    if (made.meshes.empty())
        return Error{subject + "\"" + prop.node->getName() + "\" has no still geometry with vertices of three floats"};
    return std::move(made.meshes);
}

} // namespace osgGpuAnimation
