// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/MatrixTransform>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

/// A group that follows a joint of the AnimatedCharacter above it, or of an instance of the AnimatedCrowd above it, and
/// carries its children.
///
///     osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand.R");
///     hand->addChild(sword);
///     hand->setOffset(osg::Matrix::translate(0, 4, 0));              // in the joint's space
///     fox->addChild(hand);
///     auto lost = hand->detach(*world);                              // later: the sword stays where it is
///
/// The CPU twin computes the joint's matrix from the chain of parents; nothing is read back from the GPU. The character
/// is looked up on the node path each time, so a clone of a character carries its own attachments and several
/// characters may share one. Without such a joint the attachment stays at the character's origin and warns once;
/// without such an instance of the crowd it stays where it is.
class JointAttachment : public osg::MatrixTransform
{
public:
    /// An attachment without a joint; setJoint() gives it one.
    JointAttachment();
    explicit JointAttachment(const std::string& joint) : JointAttachment() { _jointName = joint; } ///< see setJoint()
    explicit JointAttachment(int joint) : JointAttachment() { _joint = joint; } ///< joint: its index, see setJoint()
    /// Copies the joint; the children as copyop says.
    JointAttachment(const JointAttachment& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, JointAttachment)

    /// Selects the first joint of that name.
    void setJoint(const std::string& name);
    /// Selects a joint by its index in the set's skeleton.
    void setJoint(int joint);
    const std::string& getJointName() const { return _jointName; } ///< empty: selected by index
    int getJoint() const { return _joint; }                        ///< -1: selected by name

    /// Sets the place of the children relative to the joint: from their space to the joint's. Default: the identity.
    void setOffset(const osg::Matrixd& offset);
    const osg::Matrixd& getOffset() const { return _offset; } ///< see setOffset()

    /// Selects the instance of the crowd above, see AnimatedCrowd::Instance. Empty (the default): none.
    void setInstance(std::optional<std::uint64_t> instance);
    std::optional<std::uint64_t> getInstance() const { return _instance; } ///< see setInstance()

    /// Moves the children to a new transform below newParent, which shows them at the same place of the world, and
    /// removes the attachment from its parent. Returns that transform. With several paths from the root to newParent
    /// the place is right on the first. Call it outside of traversals, for example in an event callback.
    /// Errors, with nothing changed: the attachment has no parent or several paths from the root.
    Result<osg::ref_ptr<osg::MatrixTransform>> detach(osg::Group& newParent);

    /// During update: sets the matrix to the joint's transform.
    void traverse(osg::NodeVisitor& visitor) override;
    /// Applies the joint's present transform in the character of the visitor's node path.
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;
    /// Removes the joint's present transform in the character of the visitor's node path.
    bool computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;

protected:
    ~JointAttachment() override;

private:
    struct Host;

    osg::Matrixd matrixIn(const Host& host) const;
    bool isUpToDate(const Host& host) const;
    int jointIn(const AnimationSet& set) const;
    void resolve(const Host& host);

    std::string _jointName;
    int _joint = -1;
    osg::Matrixd _offset;
    std::optional<std::uint64_t> _instance;
    std::shared_ptr<const AnimationSet> _resolvedSet; ///< the set of the last look-up
    int _resolvedJoint = -1;
    bool _hasWarned = false;
    std::shared_ptr<const void> _crowd; ///< whose instance the matrix is for; null: for another state or host
    std::uint64_t _motions = 0;         ///< of that crowd, when the matrix was set
};

} // namespace osgGpuAnimation
