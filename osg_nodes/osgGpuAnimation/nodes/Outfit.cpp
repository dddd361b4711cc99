// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/Outfit.h>

namespace osgGpuAnimation
{

Outfit::Outfit(const Outfit& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), _visibility(other._visibility), _variant(other._variant), _colors(other._colors),
      _pictures(other._pictures), _jointScales(other._jointScales), _props(other._props)
{
    for (auto& [material, picture] : _pictures)
        picture = copyop(picture.get());
    for (Prop& prop : _props)
        prop.node = copyop(prop.node.get());
}

void Outfit::addProp(const std::string& joint, osg::Node* node, const osg::Matrixd& toJoint)
{
    _props.push_back({joint, node, toJoint});
}

} // namespace osgGpuAnimation
