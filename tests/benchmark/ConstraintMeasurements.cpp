// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "PoseCrowd.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <algorithm>
#include <cmath>

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
            taken(controller.constraint(move.constraint).setTarget(move.around + move.radius * away));
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

} // namespace

void measureConstraints(const Subject& subject, Run& run)
{
    const auto* const chains = std::find_if(std::begin(chainsOfSubjects), std::end(chainsOfSubjects),
                                            [&](const Chains& known) { return subject.name == known.subject; });
    if (chains == std::end(chainsOfSubjects)) return;
    const auto& [name, looks, legs] = *chains;
    const std::vector<Constraint> looking{LookAt{"first look", looks[0]}, LookAt{"second look", looks[1]}};
    const struct
    {
        const char* what;
        double bar;
        bool hasTargets;
        std::vector<Constraint> constraints;
    } variants[] = {{"pose, constraints without targets", 1.03, false, looking},
                    {"pose with two look-ats of one joint",
                     1.3,
                     true,
                     {LookAt{"first aim", {looks[0].back()}}, LookAt{"second aim", {looks[1].back()}}}},
                    {"pose with two look-ats of two or three joints", 1.3, true, looking},
                    {"pose with two legs of two-bone inverse kinematics",
                     1.5,
                     true,
                     {TwoBoneIk{"left", legs[0][0], legs[0][1], legs[0][2]},
                      TwoBoneIk{"right", legs[1][0], legs[1][1], legs[1][2]}}}};
    std::vector<std::unique_ptr<PoseCrowd>> crowds;
    std::vector<std::function<Spent()>> contestants;
    const auto compete = [&](const std::shared_ptr<const AnimationSet>& set, bool hasTargets)
    {
        crowds.push_back(std::make_unique<PoseCrowd>(set, subject.clip, run.barCount, run.context));
        contestants.push_back(
            [&crowd = *crowds.back(), hasTargets, moves = TargetMoves(*set, *chains)]() mutable
            {
                for (std::size_t i = 0; hasTargets && i < crowd.count(); ++i) // the time does not include this
                    moves(i, crowd.controllers[i]);
                return crowd.step();
            });
    };
    compete(subject.model.set, false);
    for (const auto& variant : variants)
        compete(taken(subject.set().withConstraints(variant.constraints)), variant.hasTargets);
    const std::vector<Series> series = interleaved(run.rounds, contestants);
    for (const auto& crowd : crowds)
        crowd->check();
    const double perJoint = 1e9 / static_cast<double>(run.barCount * subject.jointCount());
    for (std::size_t i = 0; i < std::size(variants); ++i)
        run.report.add(Row(subject.name, run.barCount, variants[i].what, "ns a joint", series[i + 1], perJoint)
                           .against("no constraints", series[0])
                           .atMost(variants[i].bar));
}

} // namespace osgGpuAnimation::benchmark
