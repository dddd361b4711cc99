// SPDX-License-Identifier: MIT
#include "RigNodes.h"

namespace osgGpuAnimation::scenes
{

std::vector<int> addRigNodes(GltfDocument& document, const Rig& rig, int root)
{
    std::vector<int> nodes;
    for (std::size_t i = 0; i < rig.joints().size(); ++i)
    {
        const int joint = static_cast<int>(i);
        const RigJoint& own = rig.joints()[i];
        nodes.push_back(document.addNode(own.name, own.parent < 0 ? root : nodes[own.parent],
                                         rig.restTranslation(joint), rig.restRotation(joint)));
    }
    return nodes;
}

int addRigSkin(GltfDocument& document, const std::string& name, const Rig& rig, const std::vector<int>& nodes)
{
    std::vector<int> joints;
    std::vector<glm::dmat4> inverseBinds;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (rig.joints()[i].inSkin)
        {
            joints.push_back(nodes[i]);
            inverseBinds.push_back(rig.modelToJoint(static_cast<int>(i)));
        }
    return document.addSkin(name, joints, inverseBinds, joints.front());
}

} // namespace osgGpuAnimation::scenes
