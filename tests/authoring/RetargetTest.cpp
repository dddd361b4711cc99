// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/authoring/WithClipsOf.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include "support/ClipSets.h"
#include "support/RandomSet.h"
#include "support/Results.h"
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/retarget/JointNames.h>
#include <osgGpuAnimation/authoring/retarget/RigMatch.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <random>

namespace osgGpuAnimation
{

namespace
{

using Interpolation = Channel::Interpolation;
using SetPointer = std::shared_ptr<const AnimationSet>;

/// A set with clips of channels whose targets are indices of these joints.
SetPointer makeSet(const std::vector<Joint>& joints, std::vector<std::vector<Channel>> clips,
                   const std::vector<MorphWeights>& morphs = {})
{
    const Skeleton skeleton = Skeleton::create(joints).value();
    std::vector<Clip> made;
    for (std::vector<Channel>& channels : clips)
    {
        for (Channel& channel : channels)
            if (channel.path != Channel::Path::Weights)
                channel.target = skeleton.jointOfInput(static_cast<std::size_t>(channel.target));
        made.push_back(clipOf(skeleton, channels, ("clip " + std::to_string(made.size())).c_str(), morphs));
    }
    return setOf(skeleton, made, morphs);
}

RetargetedSet retargeted(const SetPointer& set, const SetPointer& clips, const RetargetOptions& options = {})
{
    return valueOf(withClipsOf(*set, *clips, options));
}

/// The joints of a set at one time, by name.
struct PosedJoints
{
    std::map<std::string, glm::dquat> turns; ///< the difference from rest in model space
    std::map<std::string, glm::dvec3> origins;

    PosedJoints(const SetPointer& set, int clip, double time)
    {
        std::vector<JointTransform> tracks(set->trackCount());
        Pose::mix(*set, instructionAt(*set, clip, time), tracks);
        std::vector<AffineMatrix> toModel(set->skeleton().jointCount());
        Pose::jointToModel(*set, tracks, AffineMatrix(), toModel);
        const JointPlaces rest(set->skeleton());
        std::vector<glm::dquat> rotations;
        for (std::size_t joint = 0; joint < toModel.size(); ++joint)
        {
            const Joint& own = set->skeleton().joint(joint);
            const glm::dquat local = Rotation::unitQuaternion(tracks[joint].rotation);
            rotations.push_back(own.parent < 0 ? local : rotations[static_cast<std::size_t>(own.parent)] * local);
            turns[own.name] = rotations.back() * glm::conjugate(rest.rotations[joint]);
            origins[own.name] = glm::dvec3(toModel[joint].transformPoint(glm::vec3(0.0f)));
        }
    }
};

double angleBetween(const glm::dquat& a, const glm::dquat& b)
{
    const glm::dquat difference = glm::conjugate(a) * b;
    return 2.0 * std::atan2(glm::length(glm::dvec3(difference.x, difference.y, difference.z)), std::abs(difference.w));
}

glm::vec4 randomRotation(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    glm::vec4 q;
    for (int i = 0; i < 4; ++i)
        q[i] = normal(random);
    return glm::normalize(q);
}

glm::vec4 randomPlace(std::mt19937& random)
{
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    glm::vec4 place(0.0f);
    for (int i = 0; i < 3; ++i)
        place[i] = uniform(random);
    return place;
}

/// A random tree of the joints "joint 0" to "joint 11", the same for each seed, at random rest transforms. Between a
/// joint and its parent there may be a joint "extra …".
struct RandomRig
{
    std::vector<Joint> joints;
    std::vector<int> named;  ///< indices of the joints
    std::vector<int> extras; ///< of the others

    RandomRig(unsigned int treeSeed, unsigned int restSeed, bool hasExtras)
    {
        std::mt19937 tree(treeSeed), random(restSeed);
        for (int joint = 0; joint < 12; ++joint)
        {
            int parent = joint == 0 ? -1 : named[tree() % static_cast<unsigned int>(joint)];
            if (hasExtras && random() % 2 == 0)
            {
                extras.push_back(
                    add("extra " + std::to_string(restSeed) + "." + std::to_string(joint), parent, random));
                parent = extras.back();
            }
            named.push_back(add("joint " + std::to_string(joint), parent, random));
        }
    }

    int add(const std::string& name, int parent, std::mt19937& random)
    {
        Joint joint{name, parent, {}, -1};
        joint.rest.rotation = randomRotation(random);
        joint.rest.translation = randomPlace(random);
        joints.push_back(joint);
        return static_cast<int>(joints.size()) - 1;
    }
};

Channel randomTurns(int joint, Interpolation interpolation, std::mt19937& random)
{
    Channel channel{Channel::Path::Rotation, interpolation, joint, {0.0, 0.25, 1.0, 1.5}, {}};
    const bool isSpline = interpolation == Interpolation::CubicSpline;
    for (std::size_t number = 0; number < channel.times.size() * (isSpline ? 3 : 1); ++number)
    {
        const glm::vec4 q = randomRotation(random);
        channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
    }
    return channel;
}

struct TurnCase
{
    const char* name;
    std::vector<Interpolation> interpolations;
    bool extras;               ///< both rigs have joints that the other one has not
    bool extrasMove;           ///< in the clip
    std::vector<double> times; ///< at which the differences agree
};

const std::vector<double> keyTimes{0.0, 0.25, 1.0, 1.5};
const std::vector<double> anyTimes{0.0, 0.1, 0.25, 0.4, 0.77, 1.0, 1.3, 1.5};

const TurnCase turnCases[] = {
    {"linear", {Interpolation::Linear}, false, false, anyTimes},
    {"step", {Interpolation::Step}, false, false, anyTimes},
    {"cubic", {Interpolation::CubicSpline}, false, false, anyTimes},
    {"all kinds and joints without a counterpart",
     {Interpolation::CubicSpline, Interpolation::Linear, Interpolation::Step},
     true,
     false,
     anyTimes},
    {"linear, and joints without a counterpart move", {Interpolation::Linear}, true, true, keyTimes},
    {"cubic, and joints without a counterpart move", {Interpolation::CubicSpline}, true, true, keyTimes}};

void expectTheClipsTurns(const TurnCase& turn)
{
    SCOPED_TRACE(turn.name);
    for (unsigned int seed = 1; seed <= 20; ++seed)
    {
        const RandomRig from(seed, 100 + seed, turn.extras);
        const RandomRig to(seed, 200 + seed, turn.extras);
        std::mt19937 random(seed);
        std::vector<Channel> channels;
        for (std::size_t joint = 0; joint < from.named.size(); ++joint)
            channels.push_back(
                randomTurns(from.named[joint], turn.interpolations[joint % turn.interpolations.size()], random));
        for (const int extra : from.extras)
            if (turn.extrasMove) channels.push_back(randomTurns(extra, Interpolation::Linear, random));
        const SetPointer clips = makeSet(from.joints, {channels});
        const RetargetedSet result = retargeted(makeSet(to.joints, {}), clips);
        EXPECT_EQ(result.atRest.size(), to.extras.size());
        EXPECT_EQ(result.leftOut.size(), turn.extrasMove ? from.extras.size() : 0u);
        for (const double time : turn.times)
        {
            const PosedJoints wanted(clips, 0, time), made(result.set, 0, time);
            for (std::size_t joint = 0; joint < from.named.size(); ++joint)
            {
                const std::string name = "joint " + std::to_string(joint);
                EXPECT_LE(angleBetween(wanted.turns.at(name), made.turns.at(name)), 2e-5)
                    << name << " at " << time << ", seed " << seed;
            }
        }
    }
}

TEST(RetargetTest, theDifferenceFromRestInModelSpaceIsThatOfTheClip)
{
    for (const TurnCase& turn : turnCases)
        expectTheClipsTurns(turn);
}

TEST(RetargetTest, onTheSameRestPoseClipsAreCopiedBitByBit)
{
    for (const bool splines : {false, true})
    {
        const SetPointer whole = makeRandomSet({1, 30, 8, 5, splines});
        const RetargetedSet result = retargeted(whole->withClips({}).value(), whole);
        EXPECT_TRUE(result.atRest.empty());
        EXPECT_TRUE(result.leftOut.empty());
        ASSERT_EQ(result.set->clips().size(), whole->clips().size());
        for (std::size_t clip = 0; clip < whole->clips().size(); ++clip)
        {
            const Clip &wanted = whole->clips()[clip], &made = result.set->clips()[clip];
            EXPECT_EQ(made.name(), wanted.name());
            EXPECT_EQ(made.form(), wanted.form());
            EXPECT_EQ(made.times(), wanted.times());
            ASSERT_EQ(made.data().size(), wanted.data().size());
            EXPECT_EQ(
                std::memcmp(made.data().data(), wanted.data().data(), made.data().size() * sizeof(JointTransform)), 0)
                << wanted.name();
        }
    }
}

/// Hips at a height with one leg of two segments and a foot; all sizes and the parent's units are the caller's.
struct Leg
{
    float unit = 1.0f;  ///< scale of the node above the hips
    float thigh = 1.0f; ///< lengths in model space
    float shank = 1.0f;
    glm::vec4 frame{0, 0, 0, 1}; ///< the rotation of the node above the hips

    std::vector<Joint> joints() const
    {
        Joint root{"root", -1, {}, -1}, hips{"hips", 0, {}, -1}, thighJoint{"thigh", 1, {}, -1};
        Joint shankJoint{"shank", 2, {}, -1}, foot{"foot", 3, {}, -1};
        root.rest.rotation = frame;
        root.rest.scale = glm::vec4(glm::vec3(unit), 0.0f);
        const glm::quat back = glm::conjugate(glm::quat(frame.w, frame.x, frame.y, frame.z));
        const auto local = [&](float y) { return glm::vec4(back * glm::vec3(0, y, 0) / unit, 0.0f); };
        hips.rest.translation = local(thigh + shank + 0.3f);
        thighJoint.rest.translation = local(-0.2f);
        shankJoint.rest.translation = local(-thigh);
        foot.rest.translation = local(-shank);
        return {root, hips, thighJoint, shankJoint, foot};
    }
};

const float rootOfHalf = std::sqrt(0.5f);

TEST(RetargetTest, theHipsMoveByTheRatioOfTheLegs)
{
    struct Case
    {
        const char* name;
        Leg leg;
        double ratio;
    };
    const Case cases[]{
        {"the same legs", {}, 1.0},
        {"twice the legs", {1.0f, 2.0f, 2.0f}, 2.0},
        {"in centimetres", {0.01f, 1.0f, 1.0f}, 1.0},
        {"lying in its file", {1.0f, 0.5f, 0.5f, {-rootOfHalf, 0, 0, rootOfHalf}}, 0.5},
    };
    const SetPointer clips =
        makeSet(Leg().joints(), {{{Channel::Path::Translation,
                                   Interpolation::CubicSpline,
                                   1,
                                   {0.0, 1.0},
                                   {0, 0, 0, 0, 2.3, 0, 1, 2, 3, 3, 2, 1, 0.5, 2.8, -1, 0, 0, 0}}}});
    const PosedJoints before(clips, -1, 0.0);
    for (const Case& one : cases)
    {
        const SetPointer set = makeSet(one.leg.joints(), {});
        const RetargetedSet result = retargeted(set, clips);
        const PosedJoints rest(set, -1, 0.0);
        for (const double time : {0.0, 0.3, 0.5, 1.0})
        {
            const PosedJoints wanted(clips, 0, time), made(result.set, 0, time);
            for (const char* joint : {"hips", "foot"})
            {
                const glm::dvec3 way = made.origins.at(joint) - rest.origins.at(joint);
                const glm::dvec3 clipsWay = wanted.origins.at(joint) - before.origins.at(joint);
                EXPECT_LE(glm::distance(way, one.ratio * clipsWay), 2e-6)
                    << one.name << ", " << joint << " at " << time;
            }
        }
    }
}

TEST(RetargetTest, theHipsFollowAMovingJointThatTheSetHasNot)
{
    std::vector<Joint> joints = Leg().joints();
    joints.push_back({"extra", 0, {}, -1});
    joints[1].parent = 5;
    const SetPointer clips =
        makeSet(joints, {{{Channel::Path::Translation, Interpolation::Linear, 5, {0.0, 1.0}, {0, 0, 0, 1, 0, 3}}}});
    const SetPointer set = makeSet(Leg{1.0f, 2.0f, 2.0f}.joints(), {}); // the hips are 4.3 units high
    const glm::dvec3 moved = PosedJoints(retargeted(set, clips).set, 0, 1.0).origins.at("hips");
    EXPECT_LE(glm::distance(moved, glm::dvec3(2, 4.3, 6)), 1e-5);
}

/// hipsAtOrigin: the clips' skeleton rests as those of BVH files.
void expectFeetOnTheGround(bool isSpline, bool hipsAtOrigin)
{
    // A squat: the hips go down as far as the bent leg asks for.
    Channel hips{Channel::Path::Translation, Interpolation::Linear, 1, {}, {}};
    Channel thigh{Channel::Path::Rotation, Interpolation::Linear, 2, {}, {}}, shank = thigh;
    shank.target = 3;
    for (int key = 0; key <= 8; ++key)
    {
        const double bend = 0.1 * key, ofThigh = 0.5 * bend, ofShank = 1.5 * bend; // from the vertical
        for (Channel* channel : {&hips, &thigh, &shank})
            channel->times.push_back(key);
        const auto put = [](Channel& channel, std::initializer_list<double> v)
        { channel.values.insert(channel.values.end(), v); };
        if (isSpline) put(hips, {0, 0, 0});
        put(hips, {0, 0.3 + std::cos(ofThigh) + std::cos(ofShank), 0});
        if (isSpline) put(hips, {0, 0, 0});
        const double ofKnee = ofThigh + ofShank;
        put(thigh, {-std::sin(ofThigh / 2), 0, 0, std::cos(ofThigh / 2)});
        put(shank, {std::sin(ofKnee / 2), 0, 0, std::cos(ofKnee / 2)});
    }
    if (isSpline) hips.interpolation = Interpolation::CubicSpline;
    std::vector<Joint> joints = Leg().joints();
    if (hipsAtOrigin) joints[1].rest.translation = glm::vec4(0.0f);
    const SetPointer clips = makeSet(joints, {{hips, thigh, shank}});
    const double ground = hipsAtOrigin ? 0.115 : 0.1; // in parts of the leg, or as high as at rest
    const RetargetedSet result = retargeted(makeSet(Leg{1.0f, 0.7f, 1.6f}.joints(), {}), clips);
    for (int key = 0; key <= 8; ++key)
    {
        EXPECT_NEAR(PosedJoints(clips, 0, key).origins.at("foot").y, 0.1, 1e-6);
        EXPECT_NEAR(PosedJoints(result.set, 0, key).origins.at("foot").y, ground, 1e-6) << key;
        // Between keyframes the hips go straight, and feet in arcs.
        const double between = PosedJoints(clips, 0, key + 0.5).origins.at("foot").y - 0.1;
        EXPECT_NEAR(PosedJoints(result.set, 0, key + 0.5).origins.at("foot").y, ground + 1.15 * between, 2e-3) << key;
    }
}

TEST(RetargetTest, theLowestJointStaysOnTheGroundWhateverTheProportions)
{
    for (const bool isSpline : {false, true})
        for (const bool hipsAtOrigin : {false, true})
            expectFeetOnTheGround(isSpline, hipsAtOrigin);
}

TEST(RetargetTest, otherTranslationsAreTheSetsAndFactorsOfTheScaleAreKept)
{
    std::vector<Joint> from{{"hips", -1, {}, -1}, {"jaw", 0, {}, -1}, {"tail", 0, {}, -1}};
    from[1].rest.translation = glm::vec4(0, 1, 0, 0);
    from[2].rest.translation = glm::vec4(0, -1, 0, 0);
    std::vector<Joint> to = from;
    to[1].rest.translation = glm::vec4(0, 2, 0, 0);
    to[1].rest.rotation = glm::vec4(0, 0, rootOfHalf, rootOfHalf); // its x axis is y, and its y axis is -x
    to[1].rest.scale = glm::vec4(3, 3, 3, 0);
    const auto channel = [](Channel::Path path, int joint) {
        return Channel{path, Interpolation::Linear, joint, {0.0, 1.0}, {0, 1, 0, 2, 5, 1}};
    };
    const SetPointer clips = makeSet(from, {{channel(Channel::Path::Translation, 1), channel(Channel::Path::Scale, 1),
                                             channel(Channel::Path::Translation, 2)}});
    const RetargetedSet result = retargeted(makeSet(to, {}), clips);
    const Clip& clip = result.set->clips().front();
    const auto jaw = static_cast<std::size_t>(result.set->skeleton().findJoint("jaw"));
    const auto tail = static_cast<std::size_t>(result.set->skeleton().findJoint("tail"));
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_EQ(clip.at(k, jaw)->translation, to[1].rest.translation);
    EXPECT_LE(glm::distance(clip.at(1, jaw)->scale, glm::vec4(15, 6, 3, 0)), 1e-5f);
    // The tail's frame and rest translation are those of the clip.
    EXPECT_EQ(clip.at(1, tail)->translation, glm::vec4(2, 5, 1, 0));
}

TEST(RetargetTest, jointsAreMatchedByNameWithoutPrefixes)
{
    EXPECT_EQ(bareJointName("mixamorig:Hips"), "Hips");
    EXPECT_EQ(bareJointName("mixamorig12_LeftArm"), "LeftArm");
    EXPECT_EQ(bareJointName("mixamorigLeftArm"), "LeftArm");
    EXPECT_EQ(bareJointName("Armature|hero:spine.001"), "spine.001");
    EXPECT_EQ(bareJointName("Armature|hero"), "hero");
    EXPECT_EQ(bareJointName("mixamorig"), "mixamorig");
    EXPECT_EQ(bareJointName("odd:"), "odd:");

    const std::vector<std::string> others{"Hips", "mixamorig:Spine", "Arm", "Arm", ""};
    EXPECT_EQ(findCounterparts({"Hips", "Spine", "x:Spine", "tail", ""}, others, {}),
              (std::vector<int>{0, 1, 1, -1, -1}));
    EXPECT_EQ(findCounterparts({"Arm", "Arm", "Arm"}, others, {}), (std::vector<int>{2, 3, 2}));
    EXPECT_EQ(findCounterparts({"ns:Hips", "Hips", "other:Hips"}, {"Hips", "ns:Hips"}, {}), (std::vector<int>{1, 0, 0}))
        << "the same name comes before a similar one";
    EXPECT_EQ(findCounterparts({"Hips", "pelvis"}, others, {{"Hips", ""}, {"pelvis", "Hips"}}),
              (std::vector<int>{-1, 0}));
}

TEST(RetargetTest, namesOfOtherCaseAreMatchedWhereNoneOfTheSameCaseIs)
{
    EXPECT_EQ(findCounterparts({"hips", "SPINE", "Head"}, {"mixamorig:Hips", "spine", "head", "Head"}, {}),
              (std::vector<int>{0, 1, 3}));
    EXPECT_EQ(findCounterparts({"pelvis"}, {"Hips"}, {{"pelvis", "hips"}}), (std::vector<int>{0}));
    EXPECT_EQ(findCounterparts({"leg", "Leg"}, {"Leg"}, {}), (std::vector<int>{-1, 0}));
    EXPECT_EQ(findCounterparts({"Leg", "LEG"}, {"leg", "Leg"}, {}), (std::vector<int>{1, 0}));
    EXPECT_EQ(findCounterparts({"Arm_L"}, {"arm.r", "arm.l"}, {}), std::vector<int>{1}) << "exporters replace dots";
}

// One row a rig, one column a role.
TEST(RetargetTest, jointsOfKnownRigsAreMatchedByTheirRoles)
{
    const std::vector<std::vector<std::string>> rigs{
        {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Head", "mixamorig:LeftShoulder", "mixamorig:RightArm",
         "mixamorig:RightForeArm", "mixamorig:LeftUpLeg", "mixamorig:RightLeg", "mixamorig:LeftToeBase",
         "mixamorig:LeftHand", "mixamorig:RightFoot", "mixamorig:RightShoulder", "mixamorig:LeftLeg"},
        {"Hips", "LowerBack", "Head", "LeftShoulder", "RightArm", "RightForeArm", "LeftUpLeg", "RightLeg",
         "LeftToeBase", "LeftHand", "RightFoot", "RightShoulder", "LeftLeg"},
        {"pelvis", "spine_01", "head", "clavicle_l", "upperarm_r", "lowerarm_r", "thigh_l", "calf_r", "ball_l",
         "hand_l", "foot_r", "clavicle_r", "calf_l"},
        {"hips", "spine", "head", "leftShoulder", "rightUpperArm", "rightLowerArm", "leftUpperLeg", "rightLowerLeg",
         "leftToes", "leftHand", "rightFoot", "rightShoulder", "leftLowerLeg"},
        {"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Head", "J_Bip_L_Shoulder", "J_Bip_R_UpperArm", "J_Bip_R_LowerArm",
         "J_Bip_L_UpperLeg", "J_Bip_R_LowerLeg", "J_Bip_L_ToeBase", "J_Bip_L_Hand", "J_Bip_R_Foot", "J_Bip_R_Shoulder",
         "J_Bip_L_LowerLeg"},
        {"DEF-spine", "DEF-spine.001", "DEF-spine.006", "DEF-shoulder.L", "DEF-upper_arm.R", "DEF-forearm.R",
         "DEF-thigh.L", "DEF-shin.R", "DEF-toe.L", "DEF-hand.L", "DEF-foot.R", "DEF-shoulder.R", "DEF-shin.L"},
        {"Hips", "Spine", "Head", "Shoulder_L", "UpperArm.R", "LowerArm_R", "UpperLeg_L", "LowerLeg_R", "Toes_L",
         "Hand_L", "Foot_R", "Shoulder_R", "LowerLeg_L"},
    };
    std::vector<int> all(rigs[0].size());
    std::iota(all.begin(), all.end(), 0);
    for (std::size_t to = 0; to < rigs.size(); ++to)
        for (std::size_t from = 0; from < rigs.size(); ++from)
            EXPECT_EQ(findCounterparts(rigs[to], rigs[from], {}, true), all) << rigs[to][0] << " of " << rigs[from][0];
    // A given counterpart counts, and a counterpart has one joint.
    std::vector<int> given = all;
    given[0] = -1;
    EXPECT_EQ(findCounterparts(rigs[2], rigs[5], {{"pelvis", ""}}, true), given);
    std::vector<std::string> withRoot = rigs[2];
    withRoot.push_back("DEF-spine");
    std::vector<int> taken = given;
    taken.push_back(0);
    EXPECT_EQ(findCounterparts(withRoot, rigs[5], {}, true), taken);
    const std::vector<std::string> few(rigs[2].begin(), rigs[2].begin() + 11);
    EXPECT_EQ(findCounterparts(few, rigs[5], {}, true), std::vector<int>(11, -1)) << "of no known rig";
    // Two characters in one skeleton.
    const auto twice = [](std::vector<std::string> names)
    {
        const std::vector<std::string> once = names;
        names.insert(names.end(), once.begin(), once.end());
        return names;
    };
    std::vector<int> both(2 * all.size());
    std::iota(both.begin(), both.end(), 0);
    EXPECT_EQ(findCounterparts(twice(rigs[2]), twice(rigs[5]), {}, true), both);
}

/// How a joint above another one moves, whose rest rotation the clips' file does not share.
struct MatchCase
{
    const char* name;
    ClipMatch match;
    float length;                       ///< of the joint in the clips; 1 in the set
    double restAngle;                   ///< of the joint in the clips, about z in radians; 0 in the set
    double firstAngle;                  ///< of the clip, which ends at 0
    double expectedFirst, expectedLast; ///< angles
    float expectedLength;
    bool isByName;
};

const double quarter = 1.5707963267948966;

const MatchCase matchCases[] = {
    {"the first frame", ClipMatch::Automatic, 1, quarter, quarter, quarter, 0, 1, true},
    {"a rest pose of its own", ClipMatch::Automatic, 1, quarter, 0.5, 0.5 - quarter, -quarter, 1, false},
    {"other lengths", ClipMatch::Automatic, 2, quarter, quarter, 0, -quarter, 1, false},
    {"a joint that does not move", ClipMatch::Automatic, 1, quarter, quarter, 0, 0, 1, false},
    {"as asked for", ClipMatch::ByName, 2, quarter, 0.5, 0.5, 0, 2, true},
    {"not as asked for", ClipMatch::Retarget, 1, quarter, quarter, 0, -quarter, 1, false},
    {"the same rest pose", ClipMatch::Automatic, 1, 0, quarter, quarter, 0, 1, false},
};

TEST(RetargetTest, clipsWhoseRestPoseIsTheirFirstFrameAreTakenByName)
{
    const auto about = [](double angle)
    { return glm::vec4(0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))); };
    for (const MatchCase& one : matchCases)
    {
        SCOPED_TRACE(one.name);
        std::vector<Joint> own{{"low", -1, {}, -1}, {"high", 0, {}, -1}}, others = own;
        own[1].rest.translation = glm::vec4(0, 1, 0, 0);
        others[1].rest.translation = glm::vec4(0, one.length, 0, 0);
        others[1].rest.rotation = about(one.restAngle);
        const glm::vec4 first = about(one.firstAngle);
        const glm::vec4 last = one.expectedLast == one.expectedFirst ? first : about(0);
        const Channel bend{Channel::Path::Rotation,
                           Interpolation::Linear,
                           1,
                           {0.0, 1.0},
                           {first.x, first.y, first.z, first.w, last.x, last.y, last.z, last.w}};
        RetargetOptions options;
        options.match = one.match;
        const RetargetedSet result = retargeted(makeSet(own, {}), makeSet(others, {{bend}}), options);
        const auto high = static_cast<std::size_t>(result.set->skeleton().findJoint("high"));
        const Clip& clip = result.set->clips()[0];
        const auto angleAt = [&](std::size_t keyframe)
        { return 2.0 * std::atan2(clip.at(keyframe, high)->rotation.z, clip.at(keyframe, high)->rotation.w); };
        EXPECT_NEAR(angleAt(0), one.expectedFirst, 1e-6);
        EXPECT_NEAR(angleAt(clip.keyframeCount() - 1), one.expectedLast, 1e-6);
        EXPECT_EQ(clip.at(0, high)->translation.y, one.expectedLength);
        EXPECT_EQ(result.byName, one.isByName ? 2u : 0u);
        EXPECT_EQ(result.retargeted, one.isByName || one.restAngle == 0 ? 0u : 2u);
    }
}

/// A body with Mixamo's names at rest, its joints at random angles. Angles in radians: by how much the arms hang below
/// the horizontal, and how far the legs are spread. scale: of the joint above the hips.
std::vector<Joint> bodyAtRest(double arms, double legs, unsigned int seed, bool hasExtra, const glm::vec3& scale)
{
    std::mt19937 random(seed);
    std::vector<Joint> joints;
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> places;
    const auto add = [&](const std::string& name, int parent, const glm::dvec3& place)
    {
        const glm::vec4 q = parent < 0 ? glm::vec4(0, 0, 0, 1) : randomRotation(random);
        const glm::dquat rotation(q.w, q.x, q.y, q.z);
        const auto up = static_cast<std::size_t>(std::max(parent, 0));
        const glm::dquat back = parent < 0 ? glm::dquat(1, 0, 0, 0) : glm::conjugate(rotations[up]);
        const glm::dvec3 offset = back * (parent < 0 ? place : place - places[up]);
        const glm::dquat local = back * rotation;
        Joint joint{name, parent, {}, -1};
        joint.rest.rotation = glm::vec4(local.x, local.y, local.z, local.w);
        joint.rest.translation = glm::vec4(glm::vec3(offset), 0.0f);
        joints.push_back(joint);
        rotations.push_back(rotation);
        places.push_back(place);
        return static_cast<int>(joints.size()) - 1;
    };
    const int root = add("Root", -1, {}), hips = add("Hips", root, {0, 1, 0}), spine = add("Spine", hips, {0, 1.2, 0});
    add("Head", spine, {0, 1.6, 0});
    for (const auto& [name, side] :
         {std::pair<std::string, double>("Left", 1), std::pair<std::string, double>("Right", -1)})
    {
        const glm::dvec3 along(side * std::cos(arms), -std::sin(arms), 0), shoulder(side * 0.2, 1.5, 0);
        const int arm = add(name + "Arm", spine, shoulder);
        const int elbow = hasExtra ? add(name + "Helper", arm, shoulder + 0.3 * along) : arm;
        add(name + "Hand", add(name + "ForeArm", elbow, shoulder + 0.3 * along), shoulder + 0.6 * along);
        const glm::dvec3 down(side * std::sin(legs), -std::cos(legs), 0), hip(side * 0.1, 0.95, 0);
        const int shank = add(name + "Leg", add(name + "UpLeg", hips, hip), hip + 0.45 * down);
        add(name + "Foot", shank, hip + 0.9 * down);
    }
    joints.front().rest.scale = glm::vec4(scale, 0.0f);
    return joints;
}

/// One row a rest pose of the clips and one of the set; see bodyAtRest().
struct LimbCase
{
    const char* name;
    double clipsArms, clipsLegs, arms, legs;
    bool hasExtra; ///< of the clips: a joint at each elbow, which moves
    const char* unmoved;
    Interpolation interpolation = Interpolation::Linear;
    glm::vec3 scale{1.0f}; ///< of both
};

const LimbCase limbCases[] = {{"from a T to an A", 0, 0, 0.8, 0, false, ""},
                              {"from an A to a T, with spread legs", 0.9, 0.3, 0, 0.05, false, ""},
                              {"from spread legs to straight ones", 0, 0.35, 0, 0, false, ""},
                              {"a joint without a counterpart moves", 0.1, 0, 0.8, 0.2, true, ""},
                              {"arms that the clip does not move", 0, 0, 0.8, 0, false, "Arm"},
                              {"legs that the clip does not move", 0, 0.35, 0, 0, false, "Leg"},
                              {"splines", 0, 0.2, 0.8, 0, false, "", Interpolation::CubicSpline},
                              {"mirrored", 0, 0.2, 0.8, 0, false, "", Interpolation::Linear, {-1, 1, 1}}};

TEST(RetargetTest, limbsOfKnownRigsPointAsInTheClipWhateverTheRestPose)
{
    for (const LimbCase& one : limbCases)
    {
        SCOPED_TRACE(one.name);
        std::mt19937 random(7);
        const std::vector<Joint> joints = bodyAtRest(one.clipsArms, one.clipsLegs, 1, one.hasExtra, one.scale);
        std::vector<Channel> channels;
        for (std::size_t joint = 0; joint < joints.size(); ++joint)
        {
            const std::string& name = joints[joint].name;
            const bool isStill = *one.unmoved != '\0' && name.find(one.unmoved) != std::string::npos;
            if (!isStill && name.find("Hand") == std::string::npos)
                channels.push_back(randomTurns(static_cast<int>(joint), one.interpolation, random));
        }
        const SetPointer clips = makeSet(joints, {channels});
        const SetPointer set = makeSet(bodyAtRest(one.arms, one.legs, 2, false, one.scale), {});
        const SetPointer made = retargeted(set, clips).set;
        for (const double time : keyTimes)
        {
            const PosedJoints wanted(clips, 0, time), shown(made, 0, time);
            const auto boneOf = [](const PosedJoints& pose, const std::string& joint, const std::string& end)
            { return glm::normalize(pose.origins.at(end) - pose.origins.at(joint)); };
            for (const std::string side : {"Left", "Right"})
            {
                for (const auto& [joint, end] : {std::pair("Arm", "ForeArm"), std::pair("ForeArm", "Hand"),
                                                 std::pair("UpLeg", "Leg"), std::pair("Leg", "Foot")})
                    EXPECT_LE(glm::distance(boneOf(wanted, side + joint, side + end),
                                            boneOf(shown, side + joint, side + end)),
                              2e-5)
                        << side << joint << " at " << time;
                EXPECT_LE(angleBetween(wanted.turns.at(side + "Foot"), shown.turns.at(side + "Foot")), 2e-5);
                EXPECT_LE(angleBetween(wanted.turns.at("Head"), shown.turns.at("Head")), 2e-5);
            }
        }
        for (const std::string hand : {"LeftHand", "RightHand"})
        {
            const auto joint = static_cast<std::size_t>(made->skeleton().findJoint(hand));
            const glm::vec4 apart = made->clips()[0].at(1, joint)->rotation - set->restPose()[joint].rotation;
            EXPECT_LE(glm::length(apart), 1e-6f) << "hands stay in line with forearms";
        }
    }
}

TEST(RetargetTest, morphsMarkersAndNamesComeAlong)
{
    const std::vector<Joint> joints{{"hips", -1, {}, -1}, {"face", 0, {}, -1}};
    const std::vector<MorphWeights> face{{"face", -1, {0.5f, 0.0f}}};
    const Channel smile{Channel::Path::Weights, Interpolation::Linear, 0, {0.0, 2.0}, {0, 1, 1, 0.25}};
    SetPointer clips = makeSet(joints, {{smile}, {}}, face);
    clips = clips->withClips({clips->clips()[0].withMarkers({{0.5, "blink"}}).value(), clips->clips()[1]}).value();
    const std::vector<MorphWeights> own{{"hat", -1, {0.0f}}, {"face", -1, {0.0f, 0.0f}}};
    const RetargetedSet result = retargeted(makeSet(joints, {{}}, own), clips);
    EXPECT_EQ(result.atRest, std::vector<std::string>{"hat"});
    ASSERT_EQ(result.set->clips().size(), 3u);
    EXPECT_EQ(result.set->clips()[0].name(), "clip 0");
    EXPECT_EQ(result.set->clips()[1].name(), "clip 0 2");
    EXPECT_EQ(result.set->clips()[2].name(), "clip 1");
    const Clip& made = result.set->clips()[1];
    ASSERT_EQ(made.markers().size(), 1u);
    EXPECT_EQ(made.markers()[0].name, "blink");
    const std::size_t track = result.set->firstTrackOfMorph(1);
    EXPECT_EQ(made.at(1, track)->number(0), 1.0f);
    EXPECT_EQ(made.at(1, track)->number(1), 0.25f);
    const std::vector<MorphWeights> other{{"face", -1, {0.0f, 0.0f, 0.0f}}};
    EXPECT_EQ(retargeted(makeSet(joints, {}, other), clips).leftOut, std::vector<std::string>{"face"});
}

TEST(RetargetTest, rootMotionStaysOutOfClipsOfTheSameRigOnly)
{
    const SetPointer clips = makeSet(
        Leg().joints(), {{{Channel::Path::Translation, Interpolation::Linear, 1, {0.0, 1.0}, {0, 2.3, 0, 0, 2.3, 4}}}});
    const SetPointer still = withRootMotion(*clips, "hips").value();
    const RetargetedSet same = retargeted(makeSet(Leg().joints(), {}), still);
    ASSERT_TRUE(same.set->clips()[0].rootMotion());
    EXPECT_EQ(same.set->clips()[0].rootMotionAt(1.0).translation, glm::dvec3(0, 0, 4));
    EXPECT_TRUE(hasError(withClipsOf(*makeSet(Leg{1.0f, 2.0f, 2.0f}.joints(), {}), *still), "hips"));
}

TEST(RetargetTest, faultsAreErrorsThatNameThem)
{
    struct Case
    {
        const char* name;
        std::vector<Joint> joints; ///< of the clips
        std::size_t clips;
        RetargetOptions options;
        const char* message;
    };
    const std::vector<Joint> legs = Leg().joints();
    const Case cases[]{
        {"no clips", legs, 0, {}, "no clips"},
        {"no shared joint", {{"wheel", -1, {}, -1}}, 1, {}, "\"wheel\""},
        {"no joints", {}, 1, {}, "none"},
        {"unknown joint", legs, 1, {{{"arm", "foot"}}, ""}, "\"arm\""},
        {"unknown counterpart", legs, 1, {{{"foot", "paw"}}, ""}, "\"paw\""},
        {"unknown hips", legs, 1, {{}, "pelvis"}, "\"pelvis\""},
        {"hips without counterpart", legs, 1, {{{"hips", ""}}, "hips"}, "\"hips\""},
    };
    const SetPointer set = makeSet(legs, {});
    for (const Case& one : cases)
    {
        const SetPointer clips = makeSet(one.joints, std::vector<std::vector<Channel>>(one.clips));
        EXPECT_TRUE(hasError(withClipsOf(*set, *clips, one.options), one.message)) << one.name;
    }
}

TEST(RetargetTest, hipsAreFoundByTheirNameOrWhereTheBodyBranches)
{
    struct Case
    {
        const char* name;
        std::vector<Joint> joints;
        const char* hips;
    };
    const auto joint = [](const char* name, int parent, float y)
    {
        Joint made{name, parent, {}, -1};
        made.rest.translation = glm::vec4(0, y, 0, 0);
        return made;
    };
    const Case cases[]{
        {"by name",
         {joint("root", -1, 0), joint("ik", 0, 0), joint("ik2", 1, 0), joint("Pelvis", 0, 2), joint("leg", 3, -1),
          joint("foot", 4, -1)},
         "Pelvis"},
        {"not of one side",
         {joint("body", -1, 2), joint("hip.l", 0, 0), joint("shin", 1, -1), joint("arm", 0, 0), joint("hand", 3, -1)},
         "body"},
        {"a chain", {joint("a", -1, 0), joint("b", 0, 1)}, "a"},
    };
    for (const Case& one : cases)
    {
        const Skeleton skeleton = Skeleton::create(one.joints).value();
        const RigMatch match = RigMatch::create({skeleton, {}}, {skeleton, {}}, {}).value();
        ASSERT_EQ(match.bodies().size(), 1u) << one.name;
        EXPECT_EQ(skeleton.joint(match.joints()[match.bodies()[0].hips].joint).name, one.hips) << one.name;
    }
}

} // namespace

} // namespace osgGpuAnimation
