// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PoseStage.h>

#include <osgGpuAnimation/nodes/PoseStatistics.h>

#include <osg/UserDataContainer>

#include <limits>

namespace osgGpuAnimation
{

class PoseStage::Evaluation : public osg::Camera::DrawCallback
{
public:
    explicit Evaluation(PoseStage& stage) : _stage(stage) {}

    void operator()(osg::RenderInfo& renderInfo) const override
    {
        _stage._frame->evaluate(renderInfo, PoseStatistics::wanted(renderInfo));
        _stage._isDrawn = true;
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

osg::StateSet* PoseStage::enlist(osgUtil::CullVisitor& visitor, const AnimatedCharacter& character)
{
    return frame(visitor).enlist(character);
}

PoseFrame& PoseStage::frame(osgUtil::CullVisitor& visitor)
{
    PoseStage& stage = of(visitor);
    const unsigned int frameNumber = visitor.getFrameStamp() ? visitor.getFrameStamp()->getFrameNumber() : 0;
    if (stage._isDrawn || !stage._frame || stage._frame->frameNumber() != frameNumber)
        stage.attach(visitor, visitor.getRenderInfo().getContextID(), frameNumber);
    return *stage._frame;
}

// Attached to the visitor's main stage, wherever the traversal is now: a shadow camera's stage may come later.
void PoseStage::attach(osgUtil::CullVisitor& visitor, unsigned int contextId, unsigned int frameNumber)
{
    _frame = PoseFrame::forContext(contextId, frameNumber);
    _isDrawn = false;
    osgUtil::RenderBin* current = visitor.getCurrentRenderBin();
    visitor.setCurrentRenderBin(visitor.getRenderStage());
    accept(visitor);
    visitor.setCurrentRenderBin(current);
}

} // namespace osgGpuAnimation
