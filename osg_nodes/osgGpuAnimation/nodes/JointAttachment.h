// SPDX-License-Identifier: MIT
#pragma once

#include <osg/MatrixTransform>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

class AnimatedCharacter;
class AnimationSet;

/// A group that follows a joint of the AnimatedCharacter above it: what is put below it is carried.
///
///     osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand.R");
///     hand->addChild(sword);
///     fox->addChild(hand);
///
/// It takes the joint's matrix from the CPU twin of that joint's chain of parents, nothing is read back. The character
/// is found anew on the way from the root each time, so clones of a character carry what theirs hold, and one
/// attachment may be shared by several. Set its place in the hand by a transform below it. Where there is no such joint
/// it stays at the character's origin, with one warning, however many share it.
class JointAttachment : public osg::MatrixTransform
{
public:
    JointAttachment();
    explicit JointAttachment(const std::string& joint);
    explicit JointAttachment(int joint);
    JointAttachment(const JointAttachment& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, JointAttachment)

    /// By name (the first joint that has it), or by its number in the set's skeleton.
    void setJoint(const std::string& name);
    void setJoint(int joint);
    const std::string& getJointName() const { return _jointName; } ///< empty where it was given by number
    int getJoint() const { return _joint; }                        ///< -1 where it was given by name

    void traverse(osg::NodeVisitor& visitor) override;
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;
    bool computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override;

protected:
    ~JointAttachment() override;

private:
    osg::Matrixd matrixIn(const AnimatedCharacter& character) const;
    int jointIn(const AnimationSet& set) const;
    void resolve(const AnimatedCharacter& character);

    std::string _jointName;
    int _joint = -1;
    std::shared_ptr<const AnimationSet> _resolvedSet; ///< the last set the name was looked up in
    int _resolvedJoint = -1;
    bool _hasWarned = false;
};

} // namespace osgGpuAnimation
