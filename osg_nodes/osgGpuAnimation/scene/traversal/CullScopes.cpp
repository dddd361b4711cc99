// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/scene/traversal/CullScopes.h>

#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/MatrixTransform>
#include <osgUtil/Optimizer>
#include <osgViewer/View>

#include <algorithm>
#include <cstring>
#include <deque>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

osg::StateSet* depthOnlyState()
{
    static const osg::ref_ptr<osg::StateSet> state = []
    {
        osg::ref_ptr<osg::StateSet> made = new osg::StateSet;
        made->setDefine("POSE_DEPTH_ONLY");
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

/// The transform from the space below the path's last node to the space above its first. gone: matrices of removed
/// transforms, which are applied at the groups that replaced them.
osg::Matrix pathToWorld(const osg::NodePath& path, const std::vector<osg::Matrix>& gone)
{
    osg::Matrix toWorld;
    std::size_t used = 0;
    for (const osg::Node* node : path)
    {
        const bool isFlattened =
            node->getDataVariance() == osg::Object::STATIC && std::strcmp(node->className(), "Group") == 0;
        if (const osg::Transform* transform = node->asTransform())
            transform->computeLocalToWorldMatrix(toWorld, nullptr);
        else if (isFlattened && used < gone.size())
        {
            // Each matrix on the stack includes the ones before it.
            const osg::Matrix before = used > 0 ? osg::Matrix::inverse(gone[used - 1]) : osg::Matrix();
            toWorld.preMult(gone[used] * before);
            ++used;
        }
    }
    return toWorld;
}

/// The camera of the osgViewer::View that shows the node; null if there is none.
osg::Camera* viewCameraAbove(const osg::Node& node)
{
    const auto viewOf = [](const osg::Node& each) -> const osg::View*
    {
        const auto* camera = dynamic_cast<const osg::Camera*>(&each);
        return camera ? dynamic_cast<const osgViewer::View*>(camera->getView()) : nullptr;
    };
    const osg::Node* found = findAbove(node, [&](const osg::Node& each) { return viewOf(each) != nullptr; });
    return found ? const_cast<osg::Camera*>(viewOf(*found)->getCamera()) : nullptr;
}

/// The actions of runAfterUpdate() in one frame. A viewer runs the update callbacks of its cameras after those of its
/// scenes.
class AfterUpdate : public osg::NodeCallback
{
public:
    /// The object at the camera; attaches a new one if there is none.
    static AfterUpdate& of(osg::Camera& camera)
    {
        for (osg::Callback* callback = camera.getUpdateCallback(); callback; callback = callback->getNestedCallback())
            if (auto* present = dynamic_cast<AfterUpdate*>(callback)) return *present;
        const osg::ref_ptr<AfterUpdate> attached = new AfterUpdate;
        attached->setNestedCallback(camera.getUpdateCallback());
        camera.setUpdateCallback(attached);
        return *attached;
    }

    void add(std::function<void()> action, unsigned int frameNumber)
    {
        const osg::ref_ptr<AfterUpdate> self = this;
        // An application that does not call the callbacks of its cameras gets its events one frame later.
        if (frameNumber != _frameNumber) runAll();
        _frameNumber = frameNumber;
        _actions.push_back(std::move(action));
    }

    void operator()(osg::Node* camera, osg::NodeVisitor* visitor) override
    {
        const osg::ref_ptr<AfterUpdate> self = this;
        traverse(camera, visitor);
        runAll();
        camera->removeUpdateCallback(this);
    }

private:
    void runAll()
    {
        while (!_actions.empty()) // actions may add more
        {
            const std::function<void()> action = std::move(_actions.front());
            _actions.pop_front();
            action();
        }
    }

    std::deque<std::function<void()>> _actions;
    unsigned int _frameNumber = 0;
};

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

bool isDefined(osg::State& state, const std::string& name)
{
    const auto& defines = state.getDefineMap().map;
    const auto known = defines.find(name);
    return known != defines.end() && !known->second.defineVec.empty() &&
           (known->second.defineVec.back().second & osg::StateAttribute::ON);
}

bool keepFlattenedPlace(osg::Node& node, osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() != osg::NodeVisitor::NODE_VISITOR) return false;
    if (dynamic_cast<const osgUtil::Optimizer::TextureAtlasVisitor*>(&visitor)) return true;
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

void runAfterUpdate(osg::Node& node, std::function<void()> action)
{
    osg::Camera* camera = viewCameraAbove(node);
    if (!camera) return action();
    const osg::FrameStamp* stamp = camera->getView()->getFrameStamp();
    AfterUpdate::of(*camera).add(std::move(action), stamp ? stamp->getFrameNumber() : 0);
}

} // namespace osgGpuAnimation
