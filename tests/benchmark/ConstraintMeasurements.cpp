// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "PoseCrowd.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <cmath>
#include <iostream>

namespace osgGpuAnimation::benchmark
{

namespace
{

using Names = std::vector<std::string>;

/// The chains of a subject: two that look, and two legs of three joints each.
struct Chains
{
    const char* subject;
    Names looks[2];
    Names legs[2];
};

const Chains chainsOfSubjects[] = {
    {"Wanderer",
     {{"Chest", "Neck", "Head"}, {"LowerArm_L", "Hand_L"}},
     {{"UpperLeg_L", "LowerLeg_L", "Foot_L"}, {"UpperLeg_R", "LowerLeg_R", "Foot_R"}}},
    {"Fox",
     {{"b_Spine02_03", "b_Neck_04", "b_Head_05"}, {"b_Tail01_012", "b_Tail02_013", "b_Tail03_014"}},
     {{"b_LeftLeg01_015", "b_LeftLeg02_016", "b_LeftFoot01_017"},
      {"b_RightLeg01_019", "b_RightLeg02_020", "b_RightFoot01_021"}}},
    {"CesiumMan",
     {{"torso_joint_3", "Skeleton_neck_joint_1", "Skeleton_neck_joint_2"},
      {"Skeleton_arm_joint_R", "Skeleton_arm_joint_R__2_", "Skeleton_arm_joint_R__3_"}},
     {{"leg_joint_L_1", "leg_joint_L_2", "leg_joint_L_3"}, {"leg_joint_R_1", "leg_joint_R_2", "leg_joint_R_3"}}},
    {"Knight",
     {{"chest", "head"}, {"lowerarm.l", "wrist.l", "hand.l"}},
     {{"upperleg.l", "lowerleg.l", "foot.l"}, {"upperleg.r", "lowerleg.r", "foot.r"}}}};

std::vector<Constraint> looksOf(const Chains& chains)
{
    return {LookAt{"first look", chains.looks[0]}, LookAt{"second look", chains.looks[1]}};
}

/// The last joints alone look.
std::vector<Constraint> aimsOf(const Chains& chains)
{
    return {LookAt{"first aim", {chains.looks[0].back()}}, LookAt{"second aim", {chains.looks[1].back()}}};
}

std::vector<Constraint> legsOf(const Chains& chains)
{
    std::vector<Constraint> legs;
    for (const Names& leg : chains.legs)
        legs.push_back(TwoBoneIk{leg[2], leg[0], leg[1], leg[2]});
    return legs;
}

/// The place of a joint at rest, in model space.
glm::vec3 restPlace(const AnimationSet& set, const std::string& joint)
{
    std::vector<AffineMatrix> matrices;
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), matrices);
    const AffineMatrix& matrix = matrices[static_cast<std::size_t>(set.skeleton().findJoint(joint))];
    return {matrix.rows[0].w, matrix.rows[1].w, matrix.rows[2].w};
}

/// Moves the targets of all constraints, differently for each character: those of looks about the character, those of
/// legs about the feet at rest.
class TargetMoves
{
public:
    TargetMoves(const AnimationSet& set, const Chains& chains)
    {
        const glm::vec3 hip = restPlace(set, chains.legs[0].front()), foot = restPlace(set, chains.legs[0].back());
        const float leg = glm::distance(hip, foot);
        for (const Constraint& constraint : set.constraints())
            if (const auto* limb = std::get_if<TwoBoneIk>(&constraint))
                _moves.push_back({limb->name, restPlace(set, limb->end), 0.2f * leg});
            else
                _moves.push_back({std::get<LookAt>(constraint).name, hip, 4.0f * leg});
    }

    void operator()(std::size_t character, AnimationController& controller)
    {
        _phase += 0.01f;
        for (const Move& move : _moves)
        {
            const float angle = _phase + static_cast<float>(character);
            const glm::vec3 away(std::cos(angle), 0.5f, std::sin(angle));
            static_cast<void>(controller.constraint(move.constraint).setTarget(move.around + move.radius * away));
        }
    }

private:
    struct Move
    {
        std::string constraint;
        glm::vec3 around;
        float radius;
    };
    std::vector<Move> _moves;
    float _phase = 0.0f;
};

/// A crowd whose constraints have new targets in every step, which the time does not include.
std::function<Spent()> stepOf(PoseCrowd& crowd, const Chains& chains)
{
    return [&crowd, moves = TargetMoves(crowd.set(), chains)]() mutable
    {
        crowd.forEach([&](std::size_t character, AnimationController& controller) { moves(character, controller); });
        return crowd.step(1.0 / 60.0);
    };
}

} // namespace

Result<void> measureConstraints(const Subject& subject, const Effort& effort, osg::GraphicsContext& context,
                                Report& report)
{
    const Chains* chains = nullptr;
    for (const Chains& known : chainsOfSubjects)
        if (subject.name == known.subject) chains = &known;
    if (!chains) return {};
    std::cerr << subject.name << ": pose with constraints" << std::endl;
    const auto looking = subject.set().withConstraints(looksOf(*chains));
    const auto aiming = subject.set().withConstraints(aimsOf(*chains));
    const auto walking = subject.set().withConstraints(legsOf(*chains));
    if (!looking) return looking.error();
    if (!aiming) return aiming.error();
    if (!walking) return walking.error();
    PoseCrowd plain(subject.model.set, subject.clip, effort.barCount, context);
    PoseCrowd unused(looking.value(), subject.clip, effort.barCount, context);
    PoseCrowd aims(aiming.value(), subject.clip, effort.barCount, context);
    PoseCrowd looks(looking.value(), subject.clip, effort.barCount, context);
    PoseCrowd legs(walking.value(), subject.clip, effort.barCount, context);
    const auto step = [](PoseCrowd& crowd) { return [&crowd] { return crowd.step(1.0 / 60.0); }; };
    const std::vector<Series> series = interleaved(effort.rounds, {step(plain), step(unused), stepOf(aims, *chains),
                                                                   stepOf(looks, *chains), stepOf(legs, *chains)});
    for (PoseCrowd* crowd : {&plain, &unused, &aims, &looks, &legs})
        if (const std::string wrong = crowd->check(); !wrong.empty()) return Error{wrong};

    struct Bar
    {
        const char* what;
        const char* bar;
        double ratio;
    };
    const Bar bars[] = {{"pose, constraints without targets", "≤ 1.03", 1.03},
                        {"pose with two look-ats of one joint", "≤ 1.3", 1.3},
                        {"pose with two look-ats of two or three joints", "≤ 1.3", 1.3},
                        {"pose with two legs of two-bone inverse kinematics", "≤ 1.5", 1.5}};
    const double perJoint = 1e9 / static_cast<double>(effort.barCount * subject.jointCount());
    for (std::size_t i = 0; i < std::size(bars); ++i)
    {
        Row row = compared(series[i + 1], series[0], perJoint, false);
        row.subject = subject.name;
        row.count = effort.barCount;
        row.what = bars[i].what;
        row.unit = "ns a joint";
        row.otherName = "no constraints";
        row.bar = bars[i].bar;
        row.isMet = row.ratio.median <= bars[i].ratio;
        report.add(row);
    }
    return {};
}

} // namespace osgGpuAnimation::benchmark
