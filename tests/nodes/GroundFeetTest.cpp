// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/FeetState.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include "nodes/Walker.h"
#include "support/NotifyLog.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osgUtil/CullVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/RenderStage>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

const double pi = std::acos(-1.0);
constexpr double degree = 0.0174532925199433;

/// A surface over the profile of a height along -Y: quads of `width` metres across, from y = 10 to -30.
osg::ref_ptr<osg::Geometry> surfaceOf(const std::vector<osg::Vec2d>& profile)
{
    const osg::ref_ptr<osg::Geometry> surface = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (std::size_t i = 1; i < profile.size(); ++i)
        for (const auto& [point, x] : {std::pair(profile[i - 1], -20.0), std::pair(profile[i - 1], 20.0),
                                       std::pair(profile[i], 20.0), std::pair(profile[i], -20.0)})
            vertices->push_back(osg::Vec3(osg::Vec3d(x, -point.x(), point.y())));
    surface->setVertexArray(vertices);
    surface->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, static_cast<int>(vertices->size())));
    return surface;
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

/// A walker on a ground, in a scene.
class Stroll
{
public:
    explicit Stroll(osg::Node* ground_, double heading = 0.0) : ground(ground_)
    {
        scene->addChild(ground);
        scene->addChild(walker);
        walker->setMatrix(osg::Matrixd::rotate(heading, 0, 0, 1));
        EXPECT_TRUE(walker->getController().play("Walk"));
        EXPECT_TRUE(feet->setLegs(walker->getAnimationSet(), {{"left", "toes.L"}, {"right", "toes.R"}}));
        walker->addUpdateCallback(feet);
        updateTo(0.0);
    }

    void updateTo(double time_)
    {
        time = time_;
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        stamp->setFrameNumber(++frame);
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        scene->accept(visitor);
    }

    void walk(double seconds, double speed = Walker::speed)
    {
        walker->preMult(osg::Matrixd::translate(0, -speed * seconds, 0));
        updateTo(time + seconds);
    }

    void stand()
    {
        EXPECT_TRUE(walker->getController().play("Stand"));
        for (int frame = 0; frame < 60; ++frame)
            walk(1.0 / 60.0, 0.0);
    }

    osg::Matrixd joint(const std::string& name) const
    {
        return walker->jointToModel(name).value() * osg::computeLocalToWorld(walker->getParentalNodePaths().front());
    }
    osg::Vec3d ball(const std::string& side) const { return osg::Vec3d(0, -0.02, 0) * joint("toes." + side); }
    osg::Vec3d tip(const std::string& side) const { return osg::Vec3d(0, -0.02, 0.06) * joint("toes." + side); }
    osg::Vec3d heel(const std::string& side) const { return osg::Vec3d(0, -0.08, 0) * joint("foot." + side); }
    double phase(const std::string& side) const
    {
        return std::fmod(walker->getController().phase() + (side == "R" ? 0.5 : 0.0), 1.0);
    }

    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<osg::Node> ground;
    osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    double time = 0.0;
    unsigned int frame = 0;
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

TEST_P(GroundFeetOnTest, PlantedFeetTouchTheGroundAndDoNotSlide)
{
    Stroll stroll(GetParam().ground(), GetParam().heading * degree);
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
        SCOPED_TRACE(c.name);
        Stroll strolls[] = {Stroll(c.ground), Stroll(c.ground), Stroll(c.ground)};
        const int rates[] = {30, 60, 144};
        double sum = 0.0, hips = 0.0;
        int count = 0;
        for (int common = 1; common <= 48; ++common) // every sixth of a second
        {
            std::vector<osg::Vec3d> places[3];
            for (int i = 0; i < 3; ++i)
            {
                for (int frame = 0; frame < rates[i] / 6; ++frame)
                    strolls[i].walk(1.0 / rates[i]);
                for (const char* joint : {"hips", "foot.L", "toes.R"})
                    places[i].push_back(strolls[i].joint(joint).getTrans());
            }
            for (int i = 0; i < 2; ++i)
                for (std::size_t j = 0; j < places[i].size(); ++j)
                {
                    const double apart = (places[i][j] - places[2][j]).length();
                    sum += apart;
                    ++count;
                    if (j == 0) hips = std::max(hips, apart);
                }
        }
        RecordProperty(std::string("mean_mm_") + c.name, std::to_string(1000.0 * sum / count));
        RecordProperty(std::string("hips_mm_") + c.name, std::to_string(1000.0 * hips));
        EXPECT_LE(sum / count, c.mean);
        EXPECT_LE(hips, c.hips);
    }
}

TEST(GroundFeetTest, feetAndHipsMoveWithoutJumps)
{
    for (const double rise : {0.17, -0.17})
    {
        Stroll stroll(stairs(rise));
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

TEST(GroundFeetTest, aFootThatIsTooFarFromItsPlaceLosesIt)
{
    Stroll stroll(slope(10));
    stroll.stand();
    const osg::Vec3d start = stroll.ball("L");
    double largest = 0.0;
    for (int frame = 0; frame < 60; ++frame)
    {
        const osg::Vec3d before = stroll.ball("L");
        stroll.walk(1.0 / 60.0, 0.5);
        if (frame <= 20)
        {
            EXPECT_LT((stroll.ball("L") - start).length(), 1e-4) << "up to 18 cm behind its clip";
        }
        largest = std::max(largest, (stroll.ball("L") - before).length());
    }
    EXPECT_GT((stroll.ball("L") - start).length(), 0.2) << "beyond 0.3 of the leg";
    EXPECT_LT(largest, 0.08) << "it goes there within 0.1 s";

    const osg::Vec3d turned = stroll.ball("R"), turnedHeel = stroll.heel("R");
    for (int frame = 0; frame < 20; ++frame)
    {
        stroll.walker->preMult(osg::Matrixd::rotate(0.02, 0, 0, 1));
        stroll.walk(1.0 / 60.0, 0.0);
    }
    EXPECT_LT((stroll.ball("R") - turned).length(), 1e-4) << "0.4 radians of the hips alone";
    EXPECT_LT((stroll.heel("R") - turnedHeel).length(), 1e-4);
    stroll.walker->setMatrix(osg::Matrixd::translate(5, 5, 100));
    stroll.walk(1.0 / 60.0, 0.0);
    EXPECT_NEAR(stroll.heel("R").z(), heightBelow(*stroll.ground, stroll.heel("R")), 0.001) << "it starts anew there";
}

TEST(GroundFeetTest, feetLieOnAScaledGround)
{
    const osg::ref_ptr<osg::MatrixTransform> flattened = new osg::MatrixTransform(osg::Matrixd::scale(1, 1, 0.5));
    flattened->addChild(slope(std::atan(2.0 * std::tan(20.0 * degree)) / degree));
    Stroll plain(slope(20)), scaled(flattened);
    for (Stroll* stroll : {&plain, &scaled})
        stroll->stand();
    for (const char* side : {"L", "R"})
        EXPECT_LT((scaled.tip(side) - plain.tip(side)).length(), 1e-4) << side;
}

TEST(GroundFeetTest, markersSayWhenAFootIsPlanted)
{
    Stroll stroll(slope(0));
    const AnimationSet& set = stroll.walker->getAnimationSet();
    std::vector<Clip> clips = set.clips();
    clips[1] = clips[1].withMarkers({{0.5, "up"}, {1.5, "down"}}).value();
    ASSERT_TRUE(stroll.walker->setAnimationSet(set.withClips(clips).value()));
    ASSERT_TRUE(stroll.feet->setLegs({{"left", "toes.L", 0.0, "down", "up"}, {"right", "toes.R"}}));
    ASSERT_TRUE(stroll.walker->getController().play("Stand"));
    for (int frame = 0; frame < 230; ++frame)
    {
        const osg::Vec3d left = stroll.ball("L"), right = stroll.ball("R");
        stroll.walk(1.0 / 60.0, 0.05);
        const double time = stroll.walker->getController().time();
        if (frame < 10) continue; // it starts anew
        const bool isPlanted = time < 0.47 || time > 1.53;
        const bool isLifted = time > 0.53 && time < 1.47;
        EXPECT_LT((stroll.ball("R") - right).length(), 1e-5) << "at " << time;
        if (isPlanted || isLifted)
        {
            EXPECT_EQ((stroll.ball("L") - left).length() < 1e-5, isPlanted) << "at " << time;
        }
    }
}

TEST(GroundFeetTest, withoutGroundTheClipsRemainAndNothingIsNotFinite)
{
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    struct Case
    {
        const char* name;
        std::function<void(Stroll&)> change;
    };
    const auto move = [](Stroll& stroll, const osg::Vec3& way)
    {
        auto& vertices = dynamic_cast<osg::Vec3Array&>(*stroll.ground->asGeometry()->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex += way;
        stroll.ground->asGeometry()->dirtyGLObjects();
        stroll.ground->dirtyBound();
    };
    const Case cases[] = {
        {"there is none",
         [](Stroll& stroll)
         {
             stroll.scene->removeChild(stroll.ground);
             stroll.ground = nullptr;
         }},
        {"it has no vertices",
         [](Stroll& stroll)
         {
             stroll.ground->asGeometry()->setVertexArray(new osg::Vec3Array);
             stroll.ground->asGeometry()->removePrimitiveSet(0);
         }},
        {"it is far below",
         [&](Stroll& stroll) {
             move(stroll, {0, 0, -1e6f});
         }},
        {"it is at infinity",
         [&](Stroll& stroll) {
             move(stroll, {0, 0, -infinity});
         }},
        {"it is no number",
         [&](Stroll& stroll) {
             move(stroll, {nan, nan, nan});
         }},
        {"its mask is 0", [&](Stroll& stroll) { stroll.ground->setNodeMask(0); }},
        {"the traversal mask excludes it", [](Stroll& stroll) { stroll.feet->setTraversalMask(0); }},
        {"the person lies", [](Stroll& stroll) { stroll.walker->preMult(osg::Matrixd::rotate(1.5, 1, 0, 0)); }},
        {"the person has no size", [](Stroll& stroll) { stroll.walker->preMult(osg::Matrixd::scale(0, 0, 0)); }},
        {"the person's place is no number",
         [&](Stroll& stroll) { stroll.walker->preMult(osg::Matrixd::translate(nan, 0, 0)); }},
        {"the weight is 0", [](Stroll& stroll) { stroll.feet->setWeight(0.0); }},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        Stroll stroll(slope(20));
        for (int frame = 0; frame < 20; ++frame)
            stroll.walk(1.0 / 60.0);
        const double height = stroll.walker->getMatrix().getTrans().z();
        c.change(stroll);
        const osg::Matrixd changed = stroll.walker->getMatrix();
        for (int frame = 0; frame < 20; ++frame)
        {
            stroll.walk(1.0 / 60.0, 0.0);
            std::vector<AffineMatrix> palette;
            Pose::evaluate(stroll.walker->getAnimationSet(), stroll.walker->getController().instruction(),
                           AffineMatrix(), palette);
            for (const AffineMatrix& entry : palette)
                ASSERT_TRUE(entry.isFinite());
        }
        if (!changed.valid()) continue;
        ASSERT_TRUE(stroll.walker->getMatrix().valid());
        EXPECT_NEAR(stroll.walker->getMatrix().getTrans().z(), height, 0.001);
        PoseInstruction clips = stroll.walker->getController().instruction();
        clips.targets.clear();
        const AnimationSet& set = stroll.walker->getAnimationSet();
        const std::size_t foot = set.skeleton().jointNamed("toes.L").value();
        const osg::Vec3d wanted =
            toOsg(Pose::jointToModel(set, clips, foot)).getTrans() * stroll.walker->getFileToNode();
        const osg::Vec3d found = stroll.walker->jointToModel(foot).value().getTrans();
        EXPECT_LT((osg::Vec2d(found.x(), found.z()) - osg::Vec2d(wanted.x(), wanted.z())).length(), 1e-4)
            << "the pose of the clips; a planted foot keeps its place";
    }
}

struct FaultCase
{
    const char* name;
    std::vector<GroundLeg> legs;
    const char* message;
};

TEST(GroundFeetTest, refusesLegsThatTheSetDoesNotHave)
{
    const std::shared_ptr<const AnimationSet> set = Walker::makeSet();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const FaultCase cases[] = {
        {"no constraint", {{"left"}, {"tail"}}, "leg \"tail\": there is no constraint"},
        {"a look-at", {{"head"}}, "leg \"head\": it is a look-at"},
        {"no joint", {{"left", "toes"}}, "leg \"left\": there is no joint"},
        {"another foot", {{"left", "toes.R"}}, "leg \"left\": its toe \"toes.R\" is not below its ankle"},
        {"twice", {{"left"}, {"left", "toes.L"}}, "leg \"left\": it is there twice"},
        {"sole", {{"left", "toes.L", nan}}, "leg \"left\": its sole is nan, not finite"},
        {"markers", {{"left", "", 0.0, "down"}}, "leg \"left\": it has one marker"},
    };
    const osg::ref_ptr<GroundFeet> legs = new GroundFeet;
    GroundFeet& feet = *legs;
    ASSERT_TRUE(feet.setLegs(*set, {{"right", "toes.R"}}));
    for (const FaultCase& c : cases)
    {
        const Result<void> taken = feet.setLegs(*set, c.legs);
        ASSERT_FALSE(taken) << c.name;
        EXPECT_NE(taken.error().message.find(c.message), std::string::npos) << taken.error().message;
        ASSERT_EQ(feet.getLegs().size(), 1u) << c.name;
    }
    EXPECT_FALSE(feet.setReach(nan) || feet.setReach(0.0) || feet.setMaxTilt(2.0) || feet.setMaxTilt(nan) ||
                 feet.setLockDistance(-1.0) || feet.setWeight(1.1) || feet.setMaxDistance(nan));
}

TEST(GroundFeetTest, stopsFarFromAllCameras)
{
    Stroll stroll(slope(20));
    stroll.feet->setMaxDistance(20.0);
    stroll.walker->addCullCallback(stroll.feet);
    const auto seeFrom = [&](double away)
    {
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setViewMatrixAsLookAt({away, 0, 0}, {0, 0, 0}, {0, 0, 1});
        const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
        stage->setCamera(camera);
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(stroll.frame);
        const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
        visitor->setFrameStamp(stamp);
        visitor->setRenderStage(stage);
        visitor->setCurrentRenderBin(stage);
        visitor->pushOntoNodePath(stroll.walker);
        (*stroll.feet)(stroll.walker, visitor);
    };
    // The third is drawn by two cameras, the fourth by none.
    const std::pair<std::vector<double>, bool> drawn[] = {{{18}, true}, {{23}, false}, {{50, 5}, true}, {{}, false}};
    for (const auto& [distances, stands] : drawn)
    {
        for (int frame = 0; frame < 3; ++frame)
        {
            for (const double away : distances)
                seeFrom(away);
            stroll.walk(1.0 / 60.0);
        }
        EXPECT_EQ(stroll.walker->getController().isConstrained(), stands);
    }
}

TEST(GroundFeetTest, standsOnAGroundThatMoves)
{
    const osg::ref_ptr<osg::MatrixTransform> lift = new osg::MatrixTransform;
    lift->addChild(slope(10));
    Stroll stroll(lift);
    stroll.stand();
    const osg::Vec3d start = stroll.ball("L");
    const double standing = stroll.walker->getMatrix().getTrans().z();
    for (int frame = 0; frame < 60; ++frame)
    {
        EXPECT_NEAR(stroll.walker->getMatrix().getTrans().z() - 0.05 * frame, standing, 0.005) << "not behind the lift";
        lift->postMult(osg::Matrixd::translate(0.002, 0, 0.05));
        stroll.walk(1.0 / 60.0, 0.0);
        ASSERT_NEAR(stroll.ball("L").z(), heightBelow(*lift, stroll.ball("L")), 0.001);
        ASSERT_NEAR(stroll.heel("R").z(), heightBelow(*lift, stroll.heel("R")), 0.001);
    }
    EXPECT_LT((stroll.ball("L") - start - osg::Vec3d(0.12, 0, 3)).length(), 0.001) << "the foot moves with it";
}

TEST(GroundFeetTest, findsTheGroundInTheScene)
{
    const osg::ref_ptr<osg::Geometry> other = slope(0);
    other->setName("table");
    for (osg::Vec3& vertex : dynamic_cast<osg::Vec3Array&>(*other->getVertexArray()))
        vertex.z() += 0.3f;
    struct Case
    {
        const char* name;
        std::function<void(Stroll&)> change;
        double height;
    };
    const Case cases[] = {
        {"the node", [](Stroll&) {}, 0.0},
        {"the whole scene", [](Stroll& stroll) { stroll.feet->setGround(nullptr); }, 0.3},
        {"a name", [](Stroll& stroll) { stroll.feet->setGroundName("table"); }, 0.3},
        {"no node of the name", [](Stroll& stroll) { stroll.feet->setGroundName("chair"); }, 0.0},
        {"no character",
         [](Stroll& stroll)
         {
             stroll.feet->setGround(nullptr);
             const osg::ref_ptr<AnimatedCharacter> person = new AnimatedCharacter;
             person->addChild(stroll.scene->getChild(2));
             stroll.scene->replaceChild(stroll.scene->getChild(2), person);
         },
         0.0},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
        Stroll stroll(slope(0));
        stroll.scene->addChild(osg::clone(other.get(), osg::CopyOp::DEEP_COPY_ALL));
        c.change(stroll);
        osg::setNotifyHandler(log);
        for (int frame = 0; frame < 120; ++frame)
            stroll.walk(1.0 / 60.0);
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        EXPECT_NEAR(stroll.walker->getMatrix().getTrans().z(), c.height, 0.001);
        EXPECT_EQ(log->text.find("chair") != std::string::npos, c.name == std::string("no node of the name"));
    }
}

TEST(GroundFeetTest, standsBelowTransforms)
{
    Stroll stroll(slope(20));
    const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(
        osg::Matrixd::scale(0.5, 0.5, 0.5) * osg::Matrixd::rotate(1.0, 0, 0, 1) * osg::Matrixd::translate(3, 4, 0));
    stroll.scene->replaceChild(stroll.walker, above);
    above->addChild(stroll.walker);
    stroll.feet->reset();
    for (int frame = 0; frame < 200; ++frame)
    {
        stroll.walk(1.0 / 60.0);
        if (stroll.phase("L") < 0.15 || stroll.phase("L") > Walker::heelOff) continue;
        ASSERT_NEAR(stroll.ball("L").z(), heightBelow(*stroll.ground, stroll.ball("L")), 0.001) << frame;
        ASSERT_NEAR(stroll.heel("L").z(), heightBelow(*stroll.ground, stroll.heel("L")), 0.001) << frame;
    }
}

} // namespace

} // namespace osgGpuAnimation
