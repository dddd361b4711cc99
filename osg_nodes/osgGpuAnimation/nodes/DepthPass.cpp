// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DepthPass.h>

#include <algorithm>
#include <string>

namespace osgGpuAnimation
{

namespace
{

const std::string& defineName()
{
    static const std::string name = "POSE_DEPTH_ONLY";
    return name;
}

osg::StateSet* depthOnlyState()
{
    static const osg::ref_ptr<osg::StateSet> state = []
    {
        osg::ref_ptr<osg::StateSet> made = new osg::StateSet;
        made->setDefine(defineName());
        return made;
    }();
    return state.get();
}

} // namespace

DepthPass::DepthPass(osgUtil::CullVisitor& visitor) : _visitor(nullptr)
{
    const osg::Camera* camera = visitor.getCurrentCamera();
    if (!camera || !isOf(*camera)) return;
    _visitor = &visitor;
    _visitor->pushStateSet(depthOnlyState());
}

DepthPass::~DepthPass()
{
    if (_visitor) _visitor->popStateSet();
}

bool DepthPass::isOf(const osg::Camera& camera)
{
    const osg::Camera::BufferAttachmentMap& buffers = camera.getBufferAttachmentMap();
    return !buffers.empty() &&
           std::none_of(buffers.begin(), buffers.end(),
                        [](const auto& buffer) { return buffer.first >= osg::Camera::COLOR_BUFFER; });
}

bool isDepthPass(osg::State& state)
{
    const auto& defines = state.getDefineMap().map;
    const auto known = defines.find(defineName());
    return known != defines.end() && !known->second.defineVec.empty() &&
           (known->second.defineVec.back().second & osg::StateAttribute::ON);
}

} // namespace osgGpuAnimation
