// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/NodeVisitor>
#include <osg/Notify>

namespace osgGpuAnimation
{

namespace
{

/// The nearest character above the end of the path.
const AnimatedCharacter* characterAbove(const osg::NodePath& path)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (const auto* character = dynamic_cast<const AnimatedCharacter*>(*node)) return character;
    return nullptr;
}

} // namespace

JointAttachment::JointAttachment()
{
    // Not STATIC: the Optimizer must not flatten it. The update traversal must reach it without a callback.
    setDataVariance(osg::Object::DYNAMIC);
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

JointAttachment::JointAttachment(const std::string& joint) : JointAttachment()
{
    _jointName = joint;
}

JointAttachment::JointAttachment(int joint) : JointAttachment()
{
    _joint = joint;
}

JointAttachment::JointAttachment(const JointAttachment& other, const osg::CopyOp& copyop)
    : osg::MatrixTransform(other, copyop), _jointName(other._jointName), _joint(other._joint),
      _resolvedSet(other._resolvedSet), _resolvedJoint(other._resolvedJoint), _hasWarned(other._hasWarned)
{
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

JointAttachment::~JointAttachment() = default;

void JointAttachment::setJoint(const std::string& name)
{
    _jointName = name;
    _joint = -1;
    _resolvedSet.reset();
    _hasWarned = false;
}

void JointAttachment::setJoint(int joint)
{
    setJoint(std::string());
    _joint = joint;
}

int JointAttachment::jointIn(const AnimationSet& set) const
{
    if (&set == _resolvedSet.get()) return _resolvedJoint;
    const int joint = _jointName.empty() ? _joint : set.skeleton().findJoint(_jointName);
    return joint >= 0 && static_cast<std::size_t>(joint) < set.skeleton().jointCount() ? joint : -1;
}

void JointAttachment::resolve(const AnimatedCharacter& character)
{
    if (&character.getAnimationSet() == _resolvedSet.get()) return;
    _resolvedJoint = jointIn(character.getAnimationSet());
    _resolvedSet = character.getController().sharedSet();
    if (_resolvedJoint >= 0 || _hasWarned) return;
    _hasWarned = true;
    OSG_WARN << "osgGpuAnimation: an attachment follows joint "
             << (_jointName.empty() ? std::to_string(_joint) : "\"" + _jointName + "\"") << ", but \""
             << character.getName() << "\" has none such among its "
             << character.getAnimationSet().skeleton().jointCount() << "; it stays at the character's origin"
             << std::endl;
}

osg::Matrixd JointAttachment::matrixIn(const AnimatedCharacter& character) const
{
    const int joint = jointIn(character.getAnimationSet());
    const Result<osg::Matrixd> matrix = character.jointToModel(static_cast<std::size_t>(joint));
    return matrix ? matrix.value() : osg::Matrixd();
}

void JointAttachment::traverse(osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR)
        if (const AnimatedCharacter* character = characterAbove(visitor.getNodePath()))
        {
            resolve(*character);
            setMatrix(matrixIn(*character));
        }
    osg::MatrixTransform::traverse(visitor);
}

bool JointAttachment::computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const
{
    const AnimatedCharacter* character = visitor ? characterAbove(visitor->getNodePath()) : nullptr;
    if (!character || getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return osg::MatrixTransform::computeLocalToWorldMatrix(matrix, visitor);
    matrix.preMult(matrixIn(*character));
    return true;
}

bool JointAttachment::computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const
{
    const AnimatedCharacter* character = visitor ? characterAbove(visitor->getNodePath()) : nullptr;
    if (!character || getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return osg::MatrixTransform::computeWorldToLocalMatrix(matrix, visitor);
    matrix.postMult(osg::Matrixd::inverse(matrixIn(*character)));
    return true;
}

} // namespace osgGpuAnimation
