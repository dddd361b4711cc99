// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osg/Notify>

#include <string>

namespace osgGpuAnimation::serializers
{

namespace
{

void transferLookAt(ValueStream& stream, LookAt& look)
{
    std::size_t joints = look.joints.size(), shares = look.shares.size();
    stream.property("LookAt").values(look.name, joints);
    stream.items(look.joints, joints, [&](std::string& joint) { stream.value(joint); });
    stream.value(shares);
    stream.numbers<float>(look.shares, shares);
    stream.floats(&look.forward.x, 3).floats(&look.up.x, 3).floats(&look.offset.x, 3);
    stream.floats(&look.cone, 1).floats(&look.turnSpeed, 1).endLine();
}

void transferTwoBone(ValueStream& stream, TwoBoneIk& limb)
{
    stream.property("TwoBoneIk").values(limb.name, limb.start, limb.mid, limb.end);
    stream.floats(&limb.hinge.x, 3).floats(&limb.softReach, 1).endLine();
}

/// An application's settings of one constraint.
struct StoredTarget
{
    std::string constraint;
    ConstraintTarget target;
    glm::vec3 shown{0.0f};
};

std::vector<StoredTarget> targetsOf(const AnimationController& controller)
{
    std::vector<StoredTarget> stored;
    AnimationController copy(controller); // handles may change their controller
    for (const Constraint& constraint : controller.set().constraints())
    {
        const std::string name = std::visit([](const auto& declared) { return declared.name; }, constraint);
        const ConstraintHandle handle = copy.constraint(name);
        if (handle.hasTarget()) stored.push_back({name, handle.target(), handle.shownTarget()});
    }
    return stored;
}

/// A target that does not fit the set is dropped, with a warning.
void restore(const StoredTarget& stored, AnimationController& controller)
{
    ConstraintHandle handle = controller.constraint(stored.constraint);
    const ConstraintTarget& target = stored.target;
    std::vector<Result<void>> results{handle.setTarget(target.position), handle.setShownTarget(stored.shown),
                                      handle.setWeight(target.weight), handle.setPole(target.pole),
                                      handle.setTwist(target.twist)};
    if (target.rotation != glm::vec4(0.0f)) results.push_back(handle.setRotation(target.rotation));
    for (const Result<void>& result : results)
        if (!result)
        {
            static_cast<void>(handle.clear());
            OSG_WARN << "osgGpuAnimation: a target of a character: " << result.error().message << "; it is dropped"
                     << std::endl;
            return;
        }
}

} // namespace

void transferConstraints(ValueStream& stream, std::vector<Constraint>& constraints)
{
    stream.list("Constraints", constraints,
                [&](Constraint& constraint)
                {
                    bool isLimb = std::holds_alternative<TwoBoneIk>(constraint);
                    stream.property("IsLimb").value(isLimb).endLine();
                    if (stream.isReading() && isLimb) constraint = TwoBoneIk();
                    if (isLimb)
                        transferTwoBone(stream, std::get<TwoBoneIk>(constraint));
                    else
                        transferLookAt(stream, std::get<LookAt>(constraint));
                });
}

void transferTargets(ValueStream& stream, AnimationController& controller)
{
    std::vector<StoredTarget> targets = targetsOf(controller);
    stream.list("Targets", targets,
                [&](StoredTarget& stored)
                {
                    stream.property("Target").value(stored.constraint);
                    stream.floats(&stored.target.position.x, 3).floats(&stored.target.weight, 1);
                    stream.floats(&stored.target.pole.x, 3).floats(&stored.target.twist, 1);
                    stream.floats(&stored.target.rotation.x, 4).floats(&stored.shown.x, 3).endLine();
                });
    if (!stream.hasRead()) return;
    for (const StoredTarget& stored : targets)
        restore(stored, controller);
}

} // namespace osgGpuAnimation::serializers
