// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/FeetState.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include "nodes/UpdateVisits.h"
#include "nodes/Walker.h"
#include "support/NotifyLog.h"
#include "support/TestCrowd.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

constexpr double degree = 0.0174532925199433;

/// A parallelogram; towards, other: to the neighbours of the corner.
osg::ref_ptr<osg::Geometry> surface(const osg::Vec3& corner, const osg::Vec3& towards, const osg::Vec3& other)
{
    return osg::createTexturedQuadGeometry(corner, towards, other);
}

osg::ref_ptr<osg::Geometry> floorAt(double height, const char* name = "")
{
    osg::ref_ptr<osg::Geometry> floor = surface({-9, -9, static_cast<float>(height)}, {18, 0, 0}, {0, 18, 0});
    floor->setName(name);
    return floor;
}

/// A surface over the profile of a height along -Y: quads that are 40 metres wide.
osg::ref_ptr<osg::Geometry> surfaceOf(const std::vector<osg::Vec2d>& profile)
{
    const osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (std::size_t i = 1; i < profile.size(); ++i)
        for (const auto& [point, x] : {std::pair(profile[i - 1], -20.0), std::pair(profile[i - 1], 20.0),
                                       std::pair(profile[i], 20.0), std::pair(profile[i], -20.0)})
            vertices->push_back(osg::Vec3(osg::Vec3d(x, -point.x(), point.y())));
    made->setVertexArray(vertices);
    made->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, static_cast<int>(vertices->size())));
    return made;
}

osg::ref_ptr<osg::Geometry> slope(double degrees)
{
    const double rise = std::tan(degrees * degree);
    return surfaceOf({{-30, -30 * rise}, {30, 30 * rise}});
}

/// Steps of 0.3 m by `rise`.
osg::ref_ptr<osg::Geometry> stairs(double rise)
{
    std::vector<osg::Vec2d> profile{{-30, 0}};
    for (int step = 0; step < 60; ++step)
    {
        profile.push_back({0.8 + 0.3 * step, rise * step});
        profile.push_back({0.8 + 0.3 * step, rise * (step + 1)});
    }
    profile.push_back({60, rise * 60});
    return surfaceOf(profile);
}

double heightBelow(osg::Node& ground, const osg::Vec3d& place)
{
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> line = new osgUtil::LineSegmentIntersector(
        place + osg::Vec3d(0, 0, 0.3), place - osg::Vec3d(0, 0, 50)); // more than a step: the foot may be in one
    osgUtil::IntersectionVisitor visitor(line);
    ground.accept(visitor);
    return line->containsIntersections() ? line->getFirstIntersection().getWorldIntersectPoint().z() : -1e9;
}

/// A walker in a scene with a ground. It sees -Y and has the left foot at x = 0.1, the right one at -0.1. Legs of 0.9
/// m.
class Person
{
public:
    explicit Person(osg::Node* ground_, const char* clip = "Stand") : ground(ground_)
    {
        scene->addChild(ground);
        scene->addChild(walker);
        EXPECT_TRUE(walker->getController().play(clip));
        EXPECT_TRUE(feet->setLegs(walker->getAnimationSet(), {{"left", "toes.L"}, {"right", "toes.R"}}));
        walker->addUpdateCallback(feet);
    }

    void update(int frames = 60, double step = 1.0 / 60.0)
    {
        for (int i = 0; i < frames; ++i)
            visits.visit(*scene, time += step);
    }

    void walk(double seconds, double speed = Walker::speed)
    {
        walker->preMult(osg::Matrixd::translate(0, -speed * seconds, 0));
        update(1, seconds);
    }

    osg::Matrixd toWorld() const { return osg::computeLocalToWorld(walker->getParentalNodePaths().front()); }
    osg::Matrixd joint(const std::string& name) const { return walker->jointToModel(name).value() * toWorld(); }
    osg::Vec3d ball(const std::string& side) const { return osg::Vec3d(0, -0.02, 0) * joint("toes." + side); }
    osg::Vec3d heel(const std::string& side) const { return osg::Vec3d(0, -0.08, 0) * joint("foot." + side); }
    double height() const { return toWorld().getTrans().z(); }
    bool isConstrained() const { return !walker->getController().instruction().targets.empty(); }
    double phase(const std::string& side) const
    {
        return std::fmod(walker->getController().layer(0).playback().phase() + (side == "R" ? 0.5 : 0.0), 1.0);
    }

    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<osg::Node> ground;
    osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    osg::ref_ptr<GroundFeet> feet = new GroundFeet;
    double time = 0.0;
    UpdateVisits visits;
};

/// OSG's warnings while it lives.
struct Warnings
{
    Warnings() { osg::setNotifyHandler(log); }
    ~Warnings() { osg::setNotifyHandler(new osg::StandardNotifyHandler); }
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

struct GroundCase
{
    const char* name;
    std::function<osg::ref_ptr<osg::Geometry>()> ground;
    double heading; ///< degrees
    bool isEven;    ///< heel and ball of a foot have the same ground
    bool isDown = false;
};

void PrintTo(const GroundCase& c, std::ostream* out)
{
    *out << c.name;
}

class GroundFeetOnTest : public ::testing::TestWithParam<GroundCase>
{
};

} // namespace

TEST_P(GroundFeetOnTest, plantedFeetTouchTheGroundAndDoNotSlide)
{
    Person stroll(GetParam().ground(), "Walk");
    stroll.walker->setMatrix(osg::Matrixd::rotate(GetParam().heading * degree, 0, 0, 1));
    stroll.update(1, 0.0);
    struct Side
    {
        const char* name;
        std::optional<osg::Vec3d> start{}; ///< of the ball, once the foot has come down
        double planted = -1.0;             ///< seconds; negative: it is lifted
    };
    Side sides[] = {{"L"}, {"R"}};
    double gap = 0.0, depth = 0.0, slide = 0.0;
    int checked = 0;
    constexpr double step = 1.0 / 60.0;
    // A foot that comes down just behind the edge of a step downwards reaches its ground within the blend.
    const double settled = GetParam().isDown ? FeetState::blendSeconds - 0.5 * step : 0.0;
    for (int frame = 0; frame < 600; ++frame)
    {
        stroll.walk(step, 1.05 * Walker::speed); // without the lock feet slide by 3 cm
        for (Side& side : sides)
        {
            const double phase = stroll.phase(side.name);
            const bool isPlanted = phase < Walker::duty;
            const osg::Vec3d ball = stroll.ball(side.name), heel = stroll.heel(side.name);
            side.planted = !isPlanted ? -1.0 : side.planted < 0.0 ? 0.0 : side.planted + step;
            if (!isPlanted) side.start.reset();
            if (side.planted < settled || frame < 60) continue;
            if (!side.start) side.start = ball;
            ++checked;
            slide = std::max(slide, (ball - *side.start).length());
            const double ballGap = ball.z() - heightBelow(*stroll.ground, ball);
            const double heelGap = heel.z() - heightBelow(*stroll.ground, heel);
            depth = std::max(depth, -std::min(ballGap, heelGap));
            if (phase < Walker::heelOff) gap = std::max(gap, std::min(std::abs(ballGap), std::abs(heelGap)));
            if (GetParam().isEven) gap = std::max(gap, std::abs(ballGap));
            if (GetParam().isEven && phase < Walker::heelOff) gap = std::max(gap, std::abs(heelGap));
        }
    }
    for (const auto& [name, metres] :
         {std::pair("gap_mm", gap), std::pair("depth_mm", depth), std::pair("slide_mm", slide)})
        RecordProperty(name, std::to_string(1000.0 * metres));
    EXPECT_GT(checked, 400);
    EXPECT_LE(gap, 0.001);
    EXPECT_LE(depth, 0.001);
    EXPECT_LE(slide, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Grounds, GroundFeetOnTest,
                         ::testing::Values(GroundCase{"plane", [] { return slope(0); }, 0, true},
                                           GroundCase{"upTheSlope", [] { return slope(20); }, 0, true},
                                           GroundCase{"downTheSlope", [] { return slope(20); }, 180, true},
                                           GroundCase{"acrossTheSlope", [] { return slope(20); }, 90, true},
                                           GroundCase{"obliquely", [] { return slope(20); }, 37, true},
                                           GroundCase{"upStairs", [] { return stairs(0.17); }, 0, false},
                                           GroundCase{"downStairs", [] { return stairs(-0.17); }, 0, false, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(GroundFeetTest, equalTimesShowEqualPoses)
{
    struct Case
    {
        const char* name;
        osg::ref_ptr<osg::Geometry> ground;
        double mean, hips; ///< metres: frames see the edge of a step, and a foot that comes down, at other times
    };
    for (const Case& c : {Case{"slope", slope(20), 0.0025, 0.006}, Case{"stairs", stairs(0.17), 0.008, 0.02}})
    {
        Person strolls[] = {Person(c.ground, "Walk"), Person(c.ground, "Walk"), Person(c.ground, "Walk")};
        const int rates[] = {30, 60, 144};
        for (Person& stroll : strolls)
            stroll.update(1, 0.0);
        double sum = 0.0, hips = 0.0;
        int count = 0;
        for (int common = 1; common <= 48; ++common) // every sixth of a second
        {
            for (int i = 0; i < 3; ++i)
                for (int frame = 0; frame < rates[i] / 6; ++frame)
                    strolls[i].walk(1.0 / rates[i]);
            for (const char* joint : {"hips", "foot.L", "toes.R"})
                for (int i = 0; i < 2; ++i, ++count)
                {
                    const double apart =
                        (strolls[i].joint(joint).getTrans() - strolls[2].joint(joint).getTrans()).length();
                    sum += apart;
                    if (joint == std::string("hips")) hips = std::max(hips, apart);
                }
        }
        RecordProperty(std::string("mean_mm_") + c.name, std::to_string(1000.0 * sum / count));
        RecordProperty(std::string("hips_mm_") + c.name, std::to_string(1000.0 * hips));
        EXPECT_LE(sum / count, c.mean) << c.name;
        EXPECT_LE(hips, c.hips) << c.name;
    }
}

TEST(GroundFeetTest, feetAndHipsMoveWithoutJumps)
{
    for (const double rise : {0.17, -0.17})
    {
        Person stroll(stairs(rise), "Walk");
        stroll.update(1, 0.0);
        double fastest = 0.0;
        std::vector<osg::Vec3d> before;
        for (int frame = 0; frame < 600; ++frame)
        {
            stroll.walk(1.0 / 60.0);
            std::vector<osg::Vec3d> now;
            for (const char* joint : {"hips", "foot.L", "foot.R"})
                now.push_back(stroll.joint(joint).getTrans());
            for (std::size_t i = 0; i < before.size(); ++i)
                fastest = std::max(fastest, 60.0 * (now[i] - before[i]).length());
            before = now;
        }
        EXPECT_LE(fastest, 5.5) << "metres a second; a foot swings with 3.3, and climbs a step with 1.7";
    }
}

TEST(GroundFeetTest, feetTiltNoFurtherThanTheLimitAndStayLevelOnWalls)
{
    const double angle = 0.5;
    for (const double limit : {0.0, 0.2, 0.7})
    {
        Person person(slope(-angle / degree));
        ASSERT_TRUE(person.feet->setMaxTilt(limit));
        person.update();
        const osg::Vec3d sole = person.heel("L") - person.ball("L");
        EXPECT_NEAR(std::asin(sole.z() / sole.length()), std::min(angle, limit), 0.01) << limit;
    }
    const float steep = 20.0f; // 87 degrees, across the left foot
    const osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->addChild(surface({-9, -9, 0}, {9, 0, 0}, {0, 18, 0}));
    ground->addChild(surface({0.08f, -9, -0.02f * steep}, {0.04f, 0, 0.04f * steep}, {0, 18, 0}));
    Person person(ground);
    person.update();
    EXPECT_NEAR(person.heel("L").z(), 0.0, 0.02);
    EXPECT_NEAR(osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), person.joint("foot.L")).z(), 0.0, 0.01);
}

TEST(GroundFeetTest, groundBeyondTheReachDoesNotCount)
{
    for (const double reach : {0.2, 0.6}) // 0.18 m, 0.54 m
    {
        const osg::ref_ptr<osg::Group> ground = new osg::Group;
        ground->addChild(floorAt(0.0));
        ground->addChild(surface({0.02f, -2, 0.25f}, {2, 0, 0}, {0, 4, 0}));
        Person person(ground);
        ASSERT_TRUE(person.feet->setReach(reach));
        person.update();
        EXPECT_NEAR(person.ball("L").z(), reach < 0.5 ? 0.0 : 0.25, 0.001) << reach;
        EXPECT_NEAR(person.ball("R").z(), 0.0, 0.001) << reach;
    }
}

TEST(GroundFeetTest, aFootLosesItsPlaceAtTheLockDistanceAtALargeAngleAndAfterAJump)
{
    const auto wayUntilLost = [](double lockDistance, const osg::Matrixd& step)
    {
        Person person(floorAt(0.0));
        EXPECT_TRUE(person.feet->setLockDistance(lockDistance));
        person.update();
        const osg::Vec3d start = person.ball("L");
        int steps = 0;
        for (; steps < 200 && (person.ball("L") - start).length() < 1e-3; ++steps)
        {
            person.walker->preMult(step);
            person.update(1);
        }
        EXPECT_LT((person.ball("L") - start).length(), 0.08) << "it goes there within 0.1 s";
        return 0.01 * steps; // metres or radians
    };
    for (const double distance : {0.0, 0.1, 0.3})
        EXPECT_NEAR(wayUntilLost(distance, osg::Matrixd::translate(0, -0.01, 0)), 0.9 * distance + 0.01, 0.0101);
    EXPECT_NEAR(wayUntilLost(0.3, osg::Matrixd::rotate(0.01, 0, 0, 1)), 0.81, 0.0101);
    for (const double seconds : {0.9, 1.5})
    {
        Person person(floorAt(0.0));
        person.update();
        const osg::Vec3d start = person.ball("L");
        person.walker->preMult(osg::Matrixd::translate(0, -0.2, 0));
        person.update(1, seconds);
        EXPECT_NEAR((person.ball("L") - start).length(), seconds < 1.0 ? 0.0 : 0.2, 0.001) << seconds;
        person.walker->setMatrix(osg::Matrixd::translate(5, 5, 1));
        person.update(1);
        EXPECT_NEAR(person.heel("R").y(), 5.0, 0.1) << "it starts anew there";
        EXPECT_NEAR(person.heel("R").z(), 0.0, 0.001);
    }
}

// The highest point of the second ground is farther above its middle than its radius in its own units.
TEST(GroundFeetTest, theGroundMayBeScaled)
{
    const osg::ref_ptr<osg::MatrixTransform> flattened = new osg::MatrixTransform(osg::Matrixd::scale(1, 1, 0.5));
    flattened->addChild(slope(std::atan(2.0 * std::tan(20.0 * degree)) / degree));
    Person plain(slope(20)), scaled(flattened);
    for (Person* person : {&plain, &scaled})
        person->update();
    for (const char* side : {"toes.L", "toes.R"})
        EXPECT_LT((osg::Vec3d(0, 0, 0.06) * (scaled.joint(side)) - osg::Vec3d(0, 0, 0.06) * plain.joint(side)).length(),
                  1e-4)
            << side;
    const osg::ref_ptr<osg::MatrixTransform> large = new osg::MatrixTransform(osg::Matrixd::scale(10, 10, 10));
    large->addChild(surface({-3, 30, -20}, {6, 0, 0}, {0, -60, 40}));
    Person person(large);
    person.walker->setMatrix(osg::Matrixd::translate(0, -270, 0));
    person.feet->setGround(large->getChild(0));
    person.update();
    EXPECT_NEAR(person.height(), 180.0, 0.2);
}

/// Moves all vertices of the ground.
void move(Person& person, const osg::Vec3& way)
{
    for (osg::Vec3& vertex : dynamic_cast<osg::Vec3Array&>(*person.ground->asGeometry()->getVertexArray()))
        vertex += way;
    person.ground->dirtyBound();
}

TEST(GroundFeetTest, withoutGroundTheClipsRemainAndNothingIsNotFinite)
{
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    struct Case
    {
        const char* name;
        std::function<void(Person&)> change;
    };
    const Case cases[] = {
        {"there is none", [](Person& person) { person.scene->removeChild(person.ground); }},
        {"it has no vertices",
         [](Person& person)
         {
             person.ground->asGeometry()->setVertexArray(new osg::Vec3Array);
             person.ground->asGeometry()->removePrimitiveSet(0);
         }},
        {"it is far below", [](Person& person) { move(person, osg::Vec3(0, 0, -1e6f)); }},
        {"it is at infinity", [](Person& person) { move(person, osg::Vec3(0, 0, -infinity)); }},
        {"it is no number", [](Person& person) { move(person, osg::Vec3(nan, nan, nan)); }},
        {"its mask is 0", [](Person& person) { person.ground->setNodeMask(0); }},
        {"the traversal mask excludes it", [](Person& person) { person.feet->setTraversalMask(0); }},
        {"the person lies", [](Person& person) { person.walker->preMult(osg::Matrixd::rotate(1.5, 1, 0, 0)); }},
        {"the person has no size", [](Person& person) { person.walker->preMult(osg::Matrixd::scale(0, 0, 0)); }},
        {"the person's place is no number",
         [](Person& person) { person.walker->preMult(osg::Matrixd::translate(std::nan(""), 0, 0)); }},
        {"the weight is 0", [](Person& person) { person.feet->setWeight(0.0); }},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        Person person(slope(20), "Walk");
        for (int frame = 0; frame < 20; ++frame)
            person.walk(1.0 / 60.0);
        const double height = person.height();
        c.change(person);
        const bool isValid = person.walker->getMatrix().valid();
        const AnimationSet& set = person.walker->getAnimationSet();
        PoseInstruction pose;
        for (int frame = 0; frame < 20; ++frame)
        {
            person.walk(1.0 / 60.0, 0.0);
            pose = person.walker->getController().instruction();
            std::vector<AffineMatrix> palette;
            Pose::evaluate(set, pose, AffineMatrix(), palette);
            for (const AffineMatrix& entry : palette)
                ASSERT_TRUE(entry.isFinite());
        }
        if (!isValid) continue;
        EXPECT_NEAR(person.height(), height, 0.001);
        const osg::Vec3d found = person.walker->jointToModel("toes.L").value().getTrans();
        pose.targets.clear();
        const AffineMatrix toModel = Pose::jointToModel(set, pose, set.skeleton().jointNamed("toes.L").value());
        const osg::Vec3d wanted = toOsg(toModel).getTrans() * person.walker->getFileToNode();
        EXPECT_LT((osg::Vec2d(found.x(), found.z()) - osg::Vec2d(wanted.x(), wanted.z())).length(), 1e-4)
            << "the pose of the clips; a planted foot keeps its place";
    }
}

TEST(GroundFeetTest, legsThatFeetDoNotMoveHaveNoTargets)
{
    const std::pair<const char*, std::function<void(Person&)>> cases[] = {
        {"weight 0", [](Person& person) { EXPECT_TRUE(person.feet->setWeight(0.0)); }},
        {"out of sight", [](Person& person) { EXPECT_TRUE(person.feet->setMaxDistance(20.0)); }},
        {"a set without the right leg",
         [](Person& person)
         {
             const AnimationSet& set = person.walker->getAnimationSet();
             const auto one = set.withConstraints({TwoBoneIk{"left", "thigh.L", "shank.L", "foot.L"}});
             EXPECT_TRUE(one && person.walker->setAnimationSet(one.value()));
         }},
    };
    for (const auto& [name, change] : cases)
    {
        Person person(floorAt(0.1));
        person.update(10);
        ASSERT_TRUE(person.isConstrained());
        // A scene file restores the same state: targets in the controller, and feet that start anew.
        person.walker = osg::clone(person.walker.get(), osg::CopyOp::DEEP_COPY_CALLBACKS);
        person.scene->setChild(1, person.walker);
        person.feet = dynamic_cast<GroundFeet*>(person.walker->getUpdateCallback());
        ASSERT_TRUE(person.feet && person.isConstrained());
        const Warnings ignored;
        change(person);
        person.update(10);
        EXPECT_FALSE(person.isConstrained()) << name;
    }
}

TEST(GroundFeetTest, refusesLegsThatTheSetDoesNotHave)
{
    const std::shared_ptr<const AnimationSet> set = Walker::makeSet();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::pair<std::vector<GroundLeg>, const char*> cases[] = {
        {{{"left"}, {"tail"}}, "leg \"tail\": there is no constraint"},
        {{{"head"}}, "leg \"head\": it is a look-at"},
        {{{"left", "toes"}}, "leg \"left\": there is no joint"},
        {{{"left", "toes.R"}}, "leg \"left\": its toe \"toes.R\" is not below its ankle"},
        {{{"left"}, {"left", "toes.L"}}, "leg \"left\": it is there twice"},
        {{{"left", "toes.L", nan}}, "leg \"left\": its sole is nan, not finite"},
        {{{"left", "", 0.0, "down"}}, "leg \"left\": it has one marker"},
    };
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet;
    ASSERT_TRUE(feet->setLegs(*set, {{"right", "toes.R"}}));
    for (const auto& [legs, message] : cases)
    {
        const Result<void> taken = feet->setLegs(*set, legs);
        ASSERT_FALSE(taken) << message;
        EXPECT_NE(taken.error().message.find(message), std::string::npos) << taken.error().message;
        ASSERT_EQ(feet->getLegs().size(), 1u) << message;
    }
    EXPECT_FALSE(feet->setReach(nan) || feet->setReach(0.0) || feet->setMaxTilt(2.0) || feet->setMaxTilt(nan) ||
                 feet->setLockDistance(-1.0) || feet->setWeight(1.1) || feet->setMaxDistance(nan));
}

TEST(GroundFeetTest, stopsFarFromAllCameras)
{
    Person person(slope(20), "Walk");
    person.feet->setMaxDistance(20.0);
    // The third is drawn by two cameras, the fourth by none.
    const std::pair<std::vector<double>, bool> drawn[] = {{{18}, true}, {{23}, false}, {{50, 5}, true}, {{}, false}};
    for (const auto& [distances, stands] : drawn)
    {
        for (int frame = 0; frame < 3; ++frame)
        {
            for (const double away : distances)
                person.visits.cullFrom(osg::Vec3d(away, 0, 0), osg::Vec3d(), {person.walker}, *person.feet);
            person.walk(1.0 / 60.0);
        }
        EXPECT_EQ(person.isConstrained(), stands);
    }
}

// A turntable that rises carries a person: planted feet keep their places and directions on it.
TEST(GroundFeetTest, feetMoveAndTurnWithTheirGround)
{
    const osg::ref_ptr<osg::MatrixTransform> table = new osg::MatrixTransform;
    table->addChild(floorAt(0.1));
    Person person(table);
    person.feet->setGround(table);
    person.walker->setMatrix(osg::Matrixd::translate(0.5, 0, 0));
    person.update(10);
    const auto onTable = [&](const char* joint, const osg::Vec3d& place)
    { return place * person.joint(joint) * osg::Matrixd::inverse(table->getMatrix()); };
    const std::pair<const char*, osg::Vec3d> places[] = {{"toes.L", {}}, {"foot.L", {}}, {"foot.R", {0, 0, -0.1}}};
    std::vector<osg::Vec3d> before;
    for (const auto& [joint, place] : places)
        before.push_back(onTable(joint, place));
    const osg::Matrixd turn = osg::Matrixd::rotate(0.02, 0, 0, 1);
    for (int i = 1; i <= 30; ++i)
    {
        table->postMult(turn * osg::Matrixd::translate(0, 0, 0.05));
        person.walker->postMult(turn);
        person.update(1);
        EXPECT_NEAR(person.height(), 0.1 + 0.05 * i, 0.005) << "not behind the lift";
    }
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT((onTable(places[i].first, places[i].second) - before[i]).length(), 1e-3) << places[i].first;
}

TEST(GroundFeetTest, standsBelowTransformsAndAtTheFirstOfSeveralPlaces)
{
    Person person(slope(20), "Walk");
    const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(
        osg::Matrixd::scale(0.5, 0.5, 0.5) * osg::Matrixd::rotate(1.0, 0, 0, 1) * osg::Matrixd::translate(3, 4, 0));
    const osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrixd::translate(3, 0, 5));
    person.scene->replaceChild(person.walker, above);
    person.scene->addChild(beside);
    above->addChild(person.walker);
    beside->addChild(person.walker);
    for (int frame = 0; frame < 200; ++frame)
    {
        person.walk(1.0 / 60.0);
        if (person.phase("L") < 0.15 || person.phase("L") > Walker::heelOff) continue;
        ASSERT_NEAR(person.ball("L").z(), heightBelow(*person.ground, person.ball("L")), 0.001) << frame;
        ASSERT_NEAR(person.heel("L").z(), heightBelow(*person.ground, person.heel("L")), 0.001) << frame;
    }
}

TEST(GroundFeetTest, theWeightSharesTheHeightBetweenMatrixAndGround)
{
    const osg::Matrixd turned = osg::Matrixd::rotate(osg::PI_2, 1, 0, 0) * osg::Matrixd::scale(0.5, 0.5, 0.5);
    for (const bool isBelowTransform : {false, true})
    {
        SCOPED_TRACE(isBelowTransform);
        Person person(floorAt(0.4));
        const osg::ref_ptr<osg::MatrixTransform> lift = new osg::MatrixTransform;
        if (isBelowTransform)
        {
            lift->setMatrix(turned);
            person.scene->setChild(1, lift);
            lift->addChild(person.walker);
        }
        const auto setHeight = [&](double height)
        { person.walker->setMatrix(osg::Matrixd::translate(0, 0, height) * osg::Matrixd::inverse(lift->getMatrix())); };
        const auto heightWith = [&](double weight)
        {
            EXPECT_TRUE(person.feet->setWeight(weight));
            person.update(10);
            return person.height();
        };
        setHeight(0.0);
        EXPECT_NEAR(heightWith(0.5), 0.2, 1e-4);
        EXPECT_NEAR(heightWith(0.25), 0.1, 1e-4);
        const std::vector<ConstraintTarget>& targets = person.walker->getController().instruction().targets;
        ASSERT_EQ(targets.size(), 3u);
        EXPECT_EQ(targets[0].weight, 0.25f);
        EXPECT_EQ(targets[1].weight, 0.25f);
        setHeight(0.2);
        EXPECT_NEAR(heightWith(0.25), 0.25, 1e-4) << "moved by the application";
        EXPECT_NEAR(heightWith(0.0), 0.25, 1e-4) << "it stays";
        EXPECT_NEAR(heightWith(1.0), 0.4, 1e-4);
        EXPECT_NEAR(heightWith(0.5), 0.3, 1e-4) << "the height of the application is 0.2 still";
    }
}

TEST(GroundFeetTest, theGroundIsWhatPeopleStandOn)
{
    const auto below = [](osg::Group* parent)
    {
        parent->addChild(floorAt(0.2));
        return osg::ref_ptr<osg::Node>(parent);
    };
    const auto camera = [&](osg::Transform::ReferenceFrame frame)
    {
        osg::ref_ptr<osg::Camera> made = new osg::Camera;
        made->setReferenceFrame(frame);
        return below(made);
    };
    const osg::ref_ptr<SkinnedGeometry> board = makeTestSquare(1);
    for (osg::Vec3& corner : static_cast<osg::Vec3Array&>(*board->getVertexArray()))
        corner.set(8.0f * corner.x() - 4.0f, 8.0f * corner.z() - 4.0f, 0.2f);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(testCharacterSet(), {board});
    ASSERT_TRUE(crowd->add(osg::Matrixd(), still()));
    struct Case
    {
        const char* name;
        osg::ref_ptr<osg::Node> thing;
        double start, height;
    };
    const Case cases[] = {
        {"a face that looks down", surface({-9, -9, 0.2f}, {0, 18, 0}, {18, 0, 0}), 0.0, 0.2},
        {"a crowd", crowd, 0.0, 0.0},
        {"a character", below(new AnimatedCharacter), 0.0, 0.0},
        {"what lies before the eye", camera(osg::Transform::ABSOLUTE_RF), 0.0, 0.0},
        {"what another camera sees", camera(osg::Transform::RELATIVE_RF), 0.0, 0.2},
        {"a floor above", floorAt(3.0), 1.4, 0.0},
        {"a floor below", floorAt(3.0), 1.6, 3.0},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        Person person(floorAt(0.0));
        person.scene->addChild(c.thing);
        person.walker->setMatrix(osg::Matrixd::translate(0, 0, c.start));
        person.update();
        EXPECT_NEAR(person.height(), c.height, 0.001);
        EXPECT_NEAR(person.ball("L").z(), c.height, 0.001);
        EXPECT_NEAR(person.heel("R").z(), c.height, 0.001);
    }
}

TEST(GroundFeetTest, aNodeOrANameRestrictsTheGround)
{
    Person person(floorAt(0.1));
    person.scene->addChild(floorAt(0.3, "table"));
    person.feet->setGround(person.ground);
    person.update(10);
    EXPECT_NEAR(person.height(), 0.1, 0.001);
    const Warnings warnings;
    person.feet->setGroundName("stage");
    person.update(10);
    EXPECT_NEAR(person.height(), 0.1, 0.001) << "there is none yet: it stays";
    for (const double height : {0.25, 0.5})
    {
        SCOPED_TRACE(height);
        person.scene->addChild(floorAt(height, "stage"));
        person.feet->reset();
        person.update(10);
        EXPECT_NEAR(person.height(), height, 0.001);
        EXPECT_EQ(person.feet->getGround(), person.scene->getChild(3));
        person.scene->removeChild(3); // deletes it
        person.update(10);
        EXPECT_FALSE(person.feet->getGround());
        EXPECT_EQ(person.feet->getGroundName(), "stage") << "for scene files";
    }
    const std::string& text = warnings.log->text;
    EXPECT_NE(text.find("there is no node \"stage\""), std::string::npos) << text;
    EXPECT_EQ(text.find("there is no node"), text.rfind("there is no node")) << "one warning";
}

TEST(GroundFeetTest, copiesHaveAllSettings)
{
    osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->setName("stage");
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    ground = nullptr;
    EXPECT_FALSE(feet->getGround());
    feet->setTraversalMask(0xF0);
    EXPECT_TRUE(feet->setLegs({{"left", "toes.L"}}));
    EXPECT_TRUE(feet->setReach(0.3) && feet->setMaxTilt(0.2) && feet->setLockDistance(0.4) && feet->setWeight(0.5) &&
                feet->setMaxDistance(6.0));
    const osg::ref_ptr<GroundFeet> copy = osg::clone(feet.get());
    EXPECT_EQ(copy->getGroundName(), "stage") << "also of a deleted ground";
    EXPECT_EQ(copy->getTraversalMask(), 0xF0u);
    EXPECT_EQ(copy->getLegs().size(), 1u);
    EXPECT_EQ(copy->getReach(), 0.3);
    EXPECT_EQ(copy->getMaxTilt(), 0.2);
    EXPECT_EQ(copy->getLockDistance(), 0.4);
    EXPECT_EQ(copy->getWeight(), 0.5);
    EXPECT_EQ(copy->getMaxDistance(), 6.0);
    feet->setGround(nullptr);
    EXPECT_EQ(feet->getGroundName(), "");
}

} // namespace osgGpuAnimation
