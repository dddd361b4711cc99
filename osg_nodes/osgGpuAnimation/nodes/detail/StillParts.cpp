// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/detail/StillParts.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/detail/RigidMeshes.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/Notify>
#include <osg/UserDataContainer>
#include <osg/ValueObject>

#include <optional>
#include <string>

namespace osgGpuAnimation
{

namespace
{

const char* const jointKey = "osgGpuAnimation.stillJoint";

/// From the space that getFileToNode() leads to, to that of the joint at rest; none if the joint flattens.
std::optional<osg::Matrixd> nodeToJoint(const AnimatedCharacter& character, int joint)
{
    const AnimationSet& set = character.getAnimationSet();
    std::vector<AffineMatrix> jointToModel;
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), jointToModel);
    const osg::Matrixd jointToNode = toOsg(jointToModel[static_cast<std::size_t>(joint)]) * character.getFileToNode();
    if (determinantOf(jointToNode) == 0.0) return std::nullopt;
    return osg::Matrixd::inverse(jointToNode);
}

} // namespace

void StillParts::set(AnimatedCharacter& character, osg::Group& group, int joint)
{
    group.setUserValue(jointKey, joint);
    character.getOrCreateUserDataContainer()->addUserObject(&group);
}

osg::Group* StillParts::of(const AnimatedCharacter& character)
{
    const osg::UserDataContainer* const objects = character.getUserDataContainer();
    int joint = -1;
    for (unsigned int i = 0; objects && i < objects->getNumUserObjects(); ++i)
    {
        const auto* group = dynamic_cast<const osg::Group*>(objects->getUserObject(i));
        if (group && group->getUserValue(jointKey, joint)) return const_cast<osg::Group*>(group);
    }
    return nullptr;
}

bool StillParts::addTo(osg::Group& crowd, const AnimatedCharacter& character)
{
    osg::Group* const group = of(character);
    if (!group) return false;
    int joint = -1;
    group->getUserValue(jointKey, joint);
    const AnimationSet& set = character.getAnimationSet(); // a stored scene may hold any
    const bool isJoint = joint >= 0 && static_cast<std::size_t>(joint) < set.skeleton().jointCount();
    const int entry = isJoint ? set.entryOfRigidJoint(joint) : -1;
    const std::optional<osg::Matrixd> toEntry = entry >= 0 ? nodeToJoint(character, joint) : std::nullopt;
    const auto warn = [&](const std::string& parts, const std::string& why)
    {
        OSG_WARN << "osgGpuAnimation: \"" << character.getName() << "\": " << parts
                 << " that do not move are left out of the crowd: " << why << std::endl;
    };
    if (!toEntry)
    {
        warn("meshes", "no joint at rest places them");
        return false;
    }
    const RigidMeshes made = RigidMeshes::of(*group, static_cast<unsigned short>(entry), *toEntry);
    for (const osg::ref_ptr<SkinnedGeometry>& mesh : made.meshes)
        crowd.addChild(mesh);
    if (made.leftOut > 0)
        warn(std::to_string(made.leftOut) + " meshes",
             "they flatten, or have more than " + std::to_string(RigidMeshes::maxVertices) + " vertices in all");
    return !made.meshes.empty();
}

} // namespace osgGpuAnimation
