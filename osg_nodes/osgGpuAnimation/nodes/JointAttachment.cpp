// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/NodeVisitor>
#include <osg/Notify>

namespace osgGpuAnimation
{

namespace
{

/// For messages: the name in quotes, or the number of a joint without a name.
std::string nameOfJoint(const std::string& name, int joint)
{
    return name.empty() ? std::to_string(joint) : "\"" + name + "\"";
}

} // namespace

/// The character or crowd whose joint an attachment follows; both null: none.
struct JointAttachment::Host
{
    /// The nearest one above the end of the path, which may be the attachment.
    Host(const osg::NodePath& path, const JointAttachment& attachment)
    {
        for (auto node = path.rbegin(); node != path.rend() && !isFound(); ++node)
        {
            if (*node == &attachment) continue; // a failing cast costs a tenth of the attachment
            character = dynamic_cast<const AnimatedCharacter*>(*node);
            crowd = dynamic_cast<const AnimatedCrowd*>(*node);
        }
    }

    bool isFound() const { return character || crowd; }
    const std::shared_ptr<const AnimationSet>& set() const
    {
        return character ? character->getController().sharedSet() : crowd->getSharedAnimationSet();
    }
    const std::string& name() const { return character ? character->getName() : crowd->getName(); }

    const AnimatedCharacter* character = nullptr;
    const AnimatedCrowd* crowd = nullptr;
};

JointAttachment::JointAttachment()
{
    // Not STATIC: the Optimizer must not flatten it. The update traversal must reach it without a callback.
    setDataVariance(osg::Object::DYNAMIC);
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

JointAttachment::JointAttachment(const JointAttachment& other, const osg::CopyOp& copyop)
    : osg::MatrixTransform(other, copyop), _jointName(other._jointName), _joint(other._joint), _offset(other._offset),
      _instance(other._instance), _resolvedSet(other._resolvedSet), _resolvedJoint(other._resolvedJoint),
      _hasWarned(other._hasWarned)
{
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

JointAttachment::~JointAttachment() = default;

void JointAttachment::setJoint(const std::string& name)
{
    _jointName = name;
    _joint = -1;
    _resolvedSet.reset();
    _crowd.reset();
    _hasWarned = false;
}

void JointAttachment::setJoint(int joint)
{
    setJoint(std::string());
    _joint = joint;
}

void JointAttachment::setOffset(const osg::Matrixd& offset)
{
    _offset = offset;
    _crowd.reset();
}

void JointAttachment::setInstance(std::optional<std::uint64_t> instance)
{
    _instance = instance;
    _crowd.reset();
}

int JointAttachment::jointIn(const AnimationSet& set) const
{
    if (&set == _resolvedSet.get()) return _resolvedJoint;
    const int joint = _jointName.empty() ? _joint : set.skeleton().findJoint(_jointName);
    return joint >= 0 && static_cast<std::size_t>(joint) < set.skeleton().jointCount() ? joint : -1;
}

void JointAttachment::resolve(const Host& host)
{
    if (host.set() == _resolvedSet) return;
    _resolvedJoint = jointIn(*host.set());
    _resolvedSet = host.set();
    if (_resolvedJoint >= 0 || _hasWarned) return;
    _hasWarned = true;
    OSG_WARN << "osgGpuAnimation: an attachment follows joint " << nameOfJoint(_jointName, _joint) << ", but \""
             << host.name() << "\" has none such; its " << host.set()->skeleton().jointCount() << " joints are "
             << quotedNames(host.set()->skeleton().joints()) << "; it stays at the character's origin" << std::endl;
}

/// True if the matrix is the one in that host: cull would else evaluate the joint once more.
bool JointAttachment::isUpToDate(const Host& host) const
{
    if (!host.crowd || !_instance) return false;
    const CrowdInstances& instances = CrowdDetail::instances(*host.crowd);
    const std::size_t index = instances.indexOf(*_instance);
    return instances.identity() == _crowd && instances.motions() == _motions && index != CrowdInstances::none &&
           !instances.hasController(index);
}

osg::Matrixd JointAttachment::matrixIn(const Host& host) const
{
    if (isUpToDate(host)) return getMatrix();
    const auto joint = static_cast<std::size_t>(jointIn(*host.set()));
    if (host.character)
    {
        const Result<osg::Matrixd> matrix = host.character->jointToModel(joint);
        return matrix ? _offset * matrix.value() : _offset;
    }
    if (!_instance || !host.crowd->contains(*_instance)) return getMatrix();
    // Children of a crowd are relative to its origin.
    const Result<osg::Matrixd> matrix = host.crowd->jointToCrowd(*_instance, joint);
    return _offset * (matrix ? matrix.value() : host.crowd->getPlacement(*_instance)) *
           osg::Matrixd::translate(-host.crowd->getOrigin());
}

void JointAttachment::traverse(osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR)
        if (const Host host(visitor.getNodePath(), *this); host.isFound())
        {
            resolve(host);
            setMatrix(matrixIn(host));
            _crowd.reset();
            if (host.crowd)
            {
                _crowd = CrowdDetail::instances(*host.crowd).identity();
                _motions = CrowdDetail::instances(*host.crowd).motions();
            }
        }
    osg::MatrixTransform::traverse(visitor);
}

bool JointAttachment::computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const
{
    const Host host(visitor ? visitor->getNodePath() : osg::NodePath(), *this);
    if (!host.isFound() || getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return osg::MatrixTransform::computeLocalToWorldMatrix(matrix, visitor);
    matrix.preMult(matrixIn(host));
    return true;
}

bool JointAttachment::computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const
{
    const Host host(visitor ? visitor->getNodePath() : osg::NodePath(), *this);
    if (!host.isFound() || getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return osg::MatrixTransform::computeWorldToLocalMatrix(matrix, visitor);
    matrix.postMult(osg::Matrixd::inverse(matrixIn(host)));
    return true;
}

Result<osg::ref_ptr<osg::MatrixTransform>> JointAttachment::detach(osg::Group& newParent)
{
    const osg::NodePathList paths = getParentalNodePaths();
    if (getNumParents() != 1 || paths.size() != 1)
        return Error{"the attachment of joint " + nameOfJoint(_jointName, _joint) + " has " +
                     std::to_string(getNumParents()) + " parents and " + std::to_string(paths.size()) +
                     " paths from the root: expected one of each"};
    const osg::ref_ptr<JointAttachment> alive = this;
    osg::NodePath above = paths.front();
    above.pop_back();
    const Host host(above, *this);
    const osg::Matrixd own = host.isFound() ? matrixIn(host) : osg::Matrixd(getMatrix());
    const osg::Matrixd parentToWorld = osg::computeLocalToWorld(newParent.getParentalNodePaths().front());
    const osg::ref_ptr<osg::MatrixTransform> placed =
        new osg::MatrixTransform(own * osg::computeLocalToWorld(above) * osg::Matrixd::inverse(parentToWorld));
    placed->setName(getName());
    for (unsigned int child = 0; child < getNumChildren(); ++child)
        placed->addChild(getChild(child));
    removeChildren(0, getNumChildren());
    getParent(0)->removeChild(this);
    newParent.addChild(placed);
    return placed;
}

} // namespace osgGpuAnimation
