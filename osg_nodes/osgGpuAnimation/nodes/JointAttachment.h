// SPDX-License-Identifier: MIT
#pragma once

#include <osg/MatrixTransform>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

class AnimatedCharacter;
class AnimationSet;

/// A group that follows a joint of the AnimatedCharacter above it and carries its children.
///
///     osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand.R");
///     hand->addChild(sword);
///     fox->addChild(hand);
///
/// The CPU twin computes the joint's matrix from the chain of parents; nothing is read back from the GPU. The character
/// is looked up on the node path each time, so a clone of a character carries its own attachments and several
/// characters may share one. Place the children relative to the joint by a transform below the attachment. Without such
/// a joint the attachment stays at the character's origin and warns once.
class JointAttachment : public osg::MatrixTransform
{
public:
    /// An attachment without a joint; setJoint() gives it one.
    JointAttachment();
    explicit JointAttachment(const std::string& joint); ///< joint: its name, see setJoint()
    explicit JointAttachment(int joint);                ///< joint: its index, see setJoint()
    /// Copies the joint; the children as copyop says.
    JointAttachment(const JointAttachment& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, JointAttachment)

    /// Selects the first joint of that name.
    void setJoint(const std::string& name);
    /// Selects a joint by its index in the set's skeleton.
    void setJoint(int joint);
    const std::string& getJointName() const { return _jointName; } ///< empty: selected by index
    int getJoint() const { return _joint; }                        ///< -1: selected by name

    /// During update: sets the matrix to the joint's transform.
    void traverse(osg::NodeVisitor& visitor) override;
    /// Applies the joint's present transform in the character of the visitor's node path.
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;
    /// Removes the joint's present transform in the character of the visitor's node path.
    bool computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;

protected:
    ~JointAttachment() override;

private:
    osg::Matrixd matrixIn(const AnimatedCharacter& character) const;
    int jointIn(const AnimationSet& set) const;
    void resolve(const AnimatedCharacter& character);

    std::string _jointName;
    int _joint = -1;
    std::shared_ptr<const AnimationSet> _resolvedSet; ///< the set of the last look-up
    int _resolvedJoint = -1;
    bool _hasWarned = false;
};

} // namespace osgGpuAnimation
