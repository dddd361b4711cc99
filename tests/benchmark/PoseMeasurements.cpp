// SPDX-License-Identifier: MIT
#include "ChainSet.h"
#include "Measurements.h"
#include "PoseCrowd.h"
#include "Scenes.h"

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// A crowd of the subject as it is.
PoseCrowd crowdOf(const Subject& subject, Run& run)
{
    return PoseCrowd(subject.model.set, subject.clip, run.barCount, run.context);
}

double perJoint(const Subject& subject, std::size_t count)
{
    return 1e9 / static_cast<double>(count * subject.jointCount());
}

/// The times for one number of a subject's characters.
struct PoseSeries
{
    Series ours, bones, floor; ///< bones: empty if there are too many characters for osgAnimation
};

PoseSeries poseSeries(const Subject& subject, const ReferenceKit& kit, std::size_t count, Run& run)
{
    PoseCrowd crowd(subject.model.set, subject.clip, count, run.context);
    FeedbackFloor floor(subject.set().paletteSize() * count, run.context);
    const auto step = [&] { return crowd.step(); };
    const auto stepOfFloor = [&] { return floor.step(); };
    if (count > Run::maxReferenceCount)
    {
        const std::vector<Series> series = interleaved(run.rounds, {step, stepOfFloor});
        crowd.check();
        return {series[0], {}, series[1]};
    }
    ReferenceScene bones(subject, kit, ReferenceMode::Bones, count);
    double time = 0.0;
    const auto update = [&]
    {
        const Stopwatch stopwatch;
        bones.update(time += frameTime);
        return stopwatch.elapsed();
    };
    // The pose and the floor run after an update of osgAnimation, so that both start with cold caches.
    const std::vector<Series> series = interleaved(run.rounds, {step, update, stepOfFloor, update});
    crowd.check();
    for (const double moment : {0.4, 1.7, 3.1})
        bones.check(subject, moment);
    return {series[0], series[1], series[2]};
}

/// Poses that the application writes in every frame, as motion capture does, in place of clips.
void measureStreaming(const Subject& subject, Run& run)
{
    PoseCrowd posed = crowdOf(subject, run), clips = crowdOf(subject, run);
    std::vector<std::vector<JointTransform>> captured(16);
    for (std::vector<JointTransform>& frame : captured)
    {
        Pose::mix(subject.set(), posed.controllers[0].advance(0.05), frame);
        frame.resize(subject.jointCount());
    }
    for (AnimationController& controller : posed.controllers)
        controller.layer(0).showPose();
    std::size_t frame = 0;
    const auto stream = [&]
    {
        const Stopwatch stopwatch;
        for (AnimationController& controller : posed.controllers)
            taken(controller.layer(0).pose().setTransforms(captured[++frame % captured.size()]));
        posed.refill();
        return stopwatch.elapsed();
    };
    const auto fade = [&] // other samples, the same poses
    {
        for (AnimationController& controller : posed.controllers)
            controller.layer(0).setWeight(controller.layer(0).weight() == 1.0f ? 0.99f : 1.0f);
        posed.refill();
        return posed.evaluate();
    };
    const auto play = [&]
    {
        clips.refill();
        return clips.evaluate();
    };
    const std::vector<Series> series = interleaved(run.rounds, {stream, [&] { return posed.evaluate(); }, fade, play});
    posed.check();
    clips.check();
    const auto row = [&](const char* what, const Series& ours)
    { return Row(subject.name, run.barCount, what, "µs a character", ours, 1e6 / static_cast<double>(run.barCount)); };
    run.report.add(row("streaming all joints, from setTransforms() to the batch", series[0])
                       .atMost(1.5 * static_cast<double>(subject.jointCount()) / 51.0));
    run.report.add(row("upload and pose, all poses new", series[1]).against("no pose new", series[2]));
    run.report.add(row("pose of posed joints, without upload", series[2]).against("a clip", series[3]));
}

void addGrowth(const Subject& subject, const Figure& few, const Figure& many, Report& report)
{
    Row row(subject.name, 10000, "growth of the pose", "µs a character", many);
    row.otherName = "the same at N = 100";
    row.other = few;
    row.ratio = {many.median / few.median, many.low / few.high, many.high / few.low};
    report.add(row.atMost(1.15));
}

} // namespace

void measurePose(const Subject& subject, Run& run)
{
    const ReferenceKit kit(subject);
    std::map<std::size_t, Figure> perCharacter;
    for (const std::size_t count : run.poseCounts)
    {
        const PoseSeries series = poseSeries(subject, kit, count, run);
        perCharacter[count] = figureOf(series.ours, 1e6 / static_cast<double>(count));
        Row floor(subject.name, count, "pose", "ns a joint", series.ours, perJoint(subject, count)), bones = floor;
        floor.against("an empty feedback pass", series.floor);
        bones.fasterThan("osgAnimation's update of bones alone", series.bones);
        if (count == run.barCount)
        {
            floor.atMost(2.5);
            bones.atLeast(7.0);
        }
        run.report.add(floor);
        if (!series.bones.empty()) run.report.add(bones);
    }
    addGrowth(subject, perCharacter.at(100), perCharacter.at(10000), run.report);
    measureStreaming(subject, run);
}

void measureSamples(const Subject& subject, Run& run)
{
    PoseCrowd one = crowdOf(subject, run), four = crowdOf(subject, run), some = crowdOf(subject, run);
    four.addSamples();
    some.addSamples(20); // some characters crossfade, as in a typical crowd
    const std::vector<Series> series =
        interleaved(run.rounds, {[&] { return one.step(); }, [&] { return four.step(); }, [&] { return some.step(); }});
    for (const PoseCrowd* crowd : {&one, &four, &some})
        crowd->check();
    const auto row = [&](const char* what, const Series& ours)
    {
        return Row(subject.name, run.barCount, what, "ns a joint", ours, perJoint(subject, run.barCount))
            .against("1 blend sample", series[0]);
    };
    run.report.add(row("pose of 4 blend samples", series[1]).atMost(2.5));
    run.report.add(row("pose where 5 % have 4 blend samples", series[2]));
}

void measureChunks(const Subject& subject, Run& run)
{
    constexpr std::size_t sizes[] = {64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384};
    for (const std::size_t count : {run.barCount, run.crowdCount})
    {
        std::vector<std::unique_ptr<PoseCrowd>> crowds;
        std::vector<std::function<Spent()>> contestants;
        for (const std::size_t size : sizes)
        {
            crowds.push_back(std::make_unique<PoseCrowd>(subject.model.set, subject.clip, count, run.context));
            crowds.back()->options.chunkSize = size;
            contestants.push_back([crowd = crowds.back().get()] { return crowd->step(); });
        }
        const std::vector<Series> series = interleaved(run.rounds, contestants);
        for (std::size_t i = 0; i < crowds.size() && (i == 0 || sizes[i - 1] < count); ++i)
        {
            crowds[i]->check();
            run.report.add(Row(subject.name, count, "pose in chunks of " + std::to_string(sizes[i]), "ns a joint",
                               series[i], perJoint(subject, count))
                               .against("of 16384", series.back()));
        }
    }
}

void measureCompact(const Subject& subject, Run& run)
{
    const Subject compact = taken(loadSubject(subject.fileName, true, 1e-4));
    PoseCrowd exactCrowd = crowdOf(subject, run), compactCrowd = crowdOf(compact, run);
    const std::vector<Series> series =
        interleaved(4 * run.rounds, {[&] { return compactCrowd.step(); }, [&] { return exactCrowd.step(); }});
    compactCrowd.check();
    exactCrowd.check();
    const auto bytes = [](const Subject& of)
    { return ", " + std::to_string(PackedKeyframes(of.set()).byteSize()) + " bytes"; };
    run.report.add(Row(subject.name, run.barCount, "pose of clips within 1e-4 of the size" + bytes(compact),
                       "ns a joint", series[0], perJoint(subject, run.barCount))
                       .against("exact clips" + bytes(subject), series[1]));
}

void measureDepth(Run& run)
{
    constexpr std::size_t joints = 64;
    std::vector<std::unique_ptr<PoseCrowd>> crowds;
    std::vector<std::function<Spent()>> contestants;
    const std::vector<std::size_t> depths{1, 2, 4, 8, 16, 32, joints};
    for (const std::size_t depth : depths)
    {
        crowds.push_back(std::make_unique<PoseCrowd>(makeChains(joints / depth, depth), 0, run.barCount, run.context));
        for (const PosePipeline::Form form : {PosePipeline::Form::Fused, PosePipeline::Form::Separate})
            contestants.push_back(
                [crowd = crowds.back().get(), form]
                {
                    crowd->options.form = form;
                    return crowd->step();
                });
    }
    const std::vector<Series> series = interleaved(run.rounds, contestants);
    const double nanoseconds = 1e9 / static_cast<double>(joints * run.barCount);
    std::map<std::size_t, Series> fused;
    const auto row = [&](std::size_t depth)
    {
        return Row("chains of " + std::to_string(depth), run.barCount, "pose over depth", "ns a joint", fused[depth],
                   nanoseconds);
    };
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
        crowds[i]->check();
        fused[depths[i]] = series[2 * i];
        run.report.add(row(depths[i]).against("three passes and a walk to the root", series[2 * i + 1]));
    }
    run.report.add(row(joints).against("chains of 8", fused[8]).atMost(1.3));
}

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
