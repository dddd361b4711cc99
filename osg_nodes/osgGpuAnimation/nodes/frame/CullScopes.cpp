// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/frame/CullScopes.h>

#include <osg/MatrixTransform>
#include <osgUtil/Optimizer>

#include <algorithm>
#include <cstring>
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

/// Reads the matrices of the removed transforms above the visited node.
class Flattening : public osgUtil::Optimizer::FlattenStaticTransformsDuplicatingSharedSubgraphsVisitor
{
public:
    using Base = osgUtil::Optimizer::FlattenStaticTransformsDuplicatingSharedSubgraphsVisitor;

    static const std::vector<osg::Matrix>& matrices(const Base& visitor)
    {
        return visitor.*(&Flattening::_matrixStack);
    }
};

bool isFlattened(const osg::Node& node)
{
    return node.getDataVariance() == osg::Object::STATIC && std::strcmp(node.className(), "Group") == 0;
}

/// The transform from the space below the path's last node to the space above its first. gone: matrices of removed
/// transforms, which are applied at the groups that replaced them.
osg::Matrix pathToWorld(const osg::NodePath& path, const std::vector<osg::Matrix>& gone)
{
    osg::Matrix toWorld;
    std::size_t used = 0;
    for (const osg::Node* node : path)
    {
        if (const osg::Transform* transform = node->asTransform())
            transform->computeLocalToWorldMatrix(toWorld, nullptr);
        else if (isFlattened(*node) && used < gone.size())
        {
            // Each matrix on the stack includes the ones before it.
            const osg::Matrix before = used > 0 ? osg::Matrix::inverse(gone[used - 1]) : osg::Matrix();
            toWorld.preMult(gone[used] * before);
            ++used;
        }
    }
    return toWorld;
}

} // namespace

BoxNearFar::BoxNearFar(osgUtil::CullVisitor& visitor)
    : _visitor(visitor), _mode(visitor.getComputeNearFarMode()), _inheritance(visitor.getInheritanceMask())
{
    if (_mode == osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES ||
        _mode == osg::CullSettings::COMPUTE_NEAR_USING_PRIMITIVES)
        _visitor.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
}

BoxNearFar::~BoxNearFar()
{
    if (_visitor.getComputeNearFarMode() == _mode) return;
    _visitor.setComputeNearFarMode(_mode);
    _visitor.setInheritanceMask(_inheritance);
}

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

bool keepFlattenedPlace(osg::Node& node, osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() != osg::NodeVisitor::NODE_VISITOR) return false;
    const auto* flattening = dynamic_cast<const Flattening::Base*>(&visitor);
    osg::NodePath path = visitor.getNodePath();
    if (!flattening || Flattening::matrices(*flattening).empty() || path.size() < 2) return false;
    path.pop_back();
    osg::Group* parent = path.back()->asGroup();
    if (!parent) return false;
    const osg::Matrix left = pathToWorld(path, {});
    const osg::Matrix wanted = pathToWorld(path, Flattening::matrices(*flattening));
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(wanted * osg::Matrix::inverse(left));
    // Not STATIC: a second run of the Optimizer must keep it.
    place->setDataVariance(osg::Object::DYNAMIC);
    place->addChild(&node);
    parent->replaceChild(&node, place);
    return true;
}

} // namespace osgGpuAnimation
