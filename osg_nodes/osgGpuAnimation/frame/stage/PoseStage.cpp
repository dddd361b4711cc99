// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/stage/PoseStage.h>

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/gpu/passes/FeedbackTimer.h>

#include <osg/Stats>
#include <osg/UserDataContainer>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

bool isFinite(const osg::Matrixd& matrix)
{
    return std::all_of(matrix.ptr(), matrix.ptr() + 16, [](double number) { return std::isfinite(number); });
}

} // namespace

class PoseStage::Evaluation : public osg::Camera::DrawCallback
{
public:
    explicit Evaluation(PoseStage& stage) : _stage(stage) {}

    void operator()(osg::RenderInfo& renderInfo) const override
    {
        DeletionLists::make(*renderInfo.getState());
        _stage._frame->evaluate(*renderInfo.getState(), PoseStatistics::wanted(renderInfo));
    }

private:
    PoseStage& _stage; ///< owns this callback
};

PoseStage::PoseStage(const osgUtil::CullVisitor& visitor) : _visitor(&visitor)
{
    setName("osgGpuAnimation PoseStage");
    setRenderOrder(osg::Camera::PRE_RENDER, std::numeric_limits<int>::min());
    setClearMask(0);
    setAllowEventFocus(false);
    setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    setPreDrawCallback(new Evaluation(*this));
}

PoseStage& PoseStage::of(osgUtil::CullVisitor& visitor)
{
    osg::UserDataContainer* container = visitor.getOrCreateUserDataContainer();
    for (unsigned int i = 0; i < container->getNumUserObjects(); ++i)
    {
        auto* stage = dynamic_cast<PoseStage*>(container->getUserObject(i));
        if (stage && stage->_visitor == &visitor) return *stage;
    }
    osg::ref_ptr<PoseStage> stage = new PoseStage(visitor);
    container->addUserObject(stage);
    return *stage;
}

void PoseStage::draw(osgUtil::CullVisitor& visitor, const DrawnCharacter& character)
{
    // A position that is not finite would move the camera's far plane there, and nothing would be visible.
    if (!isFinite(*visitor.getModelViewMatrix())) return;
    PoseStage& stage = current(visitor);
    stage._draws.draw(visitor, stage._lodView, character, *stage._frame,
                      stage._frame->submit(character.node, character.controller, character.rootMatrix));
}

bool PoseStage::drawFromAbove(osgUtil::CullVisitor& visitor, const DrawnCharacter& character,
                              const osg::Matrixd& toParent)
{
    const osg::Matrixd toEye = toParent * *visitor.getModelViewMatrix();
    if (!isFinite(toEye)) return true;
    PoseStage& stage = current(visitor);
    return stage._draws.drawFromAbove(visitor, stage._lodView, character, toParent, toEye, *stage._frame);
}

void PoseStage::count(osgUtil::CullVisitor& visitor, const SkinnedGeometry& mesh, const PaletteBinding& binding)
{
    PoseStage& stage = current(visitor);
    if (stage._counted) stage._counted->add(mesh, binding);
}

PoseStage& PoseStage::current(osgUtil::CullVisitor& visitor)
{
    PoseStage& stage = of(visitor);
    const unsigned int frameNumber = visitor.getFrameStamp() ? visitor.getFrameStamp()->getFrameNumber() : 0;
    // Each cull traversal starts with an empty render stage, so an attached PoseStage belongs to the present traversal.
    const auto& attached = visitor.getRenderStage()->getPreRenderList();
    const auto isIt = [&](const auto& each) { return each.second->getCamera() == &stage; };
    if (!stage._frame || stage._frame->getFrameNumber() != frameNumber ||
        std::none_of(attached.begin(), attached.end(), isIt))
        stage.attach(visitor);
    return stage;
}

// Attaches to the visitor's main stage from any place in the traversal: a shadow camera's stage may run later.
void PoseStage::attach(osgUtil::CullVisitor& visitor)
{
    _lodView.clear();
    const osg::Camera* camera = visitor.getRenderStage()->getCamera();
    const osg::Stats* stats = camera ? camera->getStats() : nullptr;
    const bool isCounting = stats && stats->collectStats("scene");
    if (isCounting != _counted.valid())
    {
        removeChildren(0, getNumChildren());
        _counted = isCounting ? new DrawnInstances : nullptr;
        if (_counted) addChild(_counted);
    }
    else if (_counted)
        _counted->clear();
    _draws.begin(_counted);
    _frame = nullptr; // allows the frame's storage to be reused
    _frame = PoseFrame::forContext(visitor.getRenderInfo().getContextID(), visitor.getFrameStamp());
    osgUtil::RenderBin* current = visitor.getCurrentRenderBin();
    visitor.setCurrentRenderBin(visitor.getRenderStage());
    accept(visitor);
    for (auto& [order, stage] : visitor.getRenderStage()->getPreRenderList())
        if (stage->getCamera() == this) stage->setInheritedPositionalStateContainer(nullptr); // lights nothing
    visitor.setCurrentRenderBin(current);
}

} // namespace osgGpuAnimation
