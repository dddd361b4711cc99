// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/PosedTriangles.h"
#include "plugin/SharedAssets.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <gtest/gtest.h>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/IntersectionVisitor>

#include <cmath>
#include <random>

// Compares 300 random rays per model with the triangles in the CPU twin's pose, at random times, in crossfades and with
// layers, below transforms that rotate and scale, for a single character and for a crowd.

namespace osgGpuAnimation
{

namespace
{

struct PickedModel
{
    const char* name;
    const char* shared; ///< in the shared folder; null: our own scene
    const char* scene;
};

void PrintTo(const PickedModel& model, std::ostream* out)
{
    *out << model.name;
}

class PickingTest : public ::testing::TestWithParam<PickedModel>
{
protected:
    static constexpr unsigned int seed = 20261121;
    static constexpr int poses = 30, raysAPose = 10;

    std::string file() const
    {
        if (GetParam().shared) return sharedFile(GetParam().shared);
        return ownScene(GetParam().scene);
    }

    void load()
    {
        usePluginsOfTheBuild();
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("noKeys");
        options->setBuildKdTreesHint(osgDB::Options::BUILD_KDTREES);
        node = osgDB::readRefNodeFile(file(), options);
        ASSERT_TRUE(node.valid());
        character = findCharacter(*node);
        ASSERT_NE(character, nullptr);
        scene = new osg::MatrixTransform(osg::Matrix::scale(1.7, 0.6, 2.5) * osg::Matrix::rotate(0.7, 1, 2, 3) *
                                         osg::Matrix::translate(30, -4, 11));
        scene->setDataVariance(osg::Object::STATIC);
        scene->addChild(node);
    }

    double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
    osg::Vec3d direction()
    {
        std::normal_distribution<double> normal;
        osg::Vec3d drawn(normal(random), normal(random), normal(random));
        drawn.normalize();
        return drawn;
    }

    /// Plays a random clip at a random time, possibly crossfades to another, and adds or overrides with a third one.
    void playAnything(AnimationController& controller)
    {
        const std::size_t clips = controller.set().clips().size();
        if (clips == 0) return;
        EXPECT_TRUE(controller.play(random() % clips));
        controller.seek(number(0.0, controller.duration()));
        if (random() % 2)
        {
            EXPECT_TRUE(controller.crossfade(random() % clips, 1.0));
        }
        AnimationLayer& layer = controller.layer(1);
        layer.setMode(random() % 2 ? AnimationLayer::Mode::Additive : AnimationLayer::Mode::Override);
        EXPECT_TRUE(layer.play(random() % clips));
        layer.setWeight(random() % 2 ? static_cast<float>(number(0.0, 1.0)) : 0.0f);
        controller.advance(number(0.0, 0.9));
    }

    template <typename Function>
    void forEachMesh(Function function) const
    {
        for (unsigned int i = 0; i < character->getNumChildren(); ++i)
            if (auto* mesh = dynamic_cast<SkinnedGeometry*>(character->getChild(i))) function(*mesh);
    }

    PosedTriangles trianglesOfCharacter() const
    {
        PosedTriangles triangles;
        const osg::Matrixd toWorld =
            character->getFileToNode() * osg::computeLocalToWorld(character->getParentalNodePaths().front());
        forEachMesh([&](const SkinnedGeometry& mesh) { triangles.add(mesh, character->getController(), toWorld); });
        return triangles;
    }

    /// A ray that starts outside the model and passes near a random point of the mesh.
    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray(const PosedTriangles& triangles)
    {
        const osg::Vec3d target = triangles.points()[random() % triangles.points().size()] +
                                  direction() * number(0.0, 0.05) * triangles.size();
        const osg::Vec3d way = direction() * 2.0 * triangles.size();
        return new osgUtil::LineSegmentIntersector(target - way, target + way);
    }

    /// Compares the ray's first hit with the triangles. crowd: null if the character is picked.
    void check(osgUtil::LineSegmentIntersector& ray, const PosedTriangles& triangles, const AnimatedCrowd* crowd)
    {
        osgUtil::IntersectionVisitor visitor(&ray);
        scene->accept(visitor);
        const std::vector<PosedTriangles::Hit> expected = triangles.hits(ray.getStart(), ray.getEnd());
        const double tolerance = 1e-4 * triangles.size();
        double sure = INFINITY;
        for (const PosedTriangles::Hit& hit : expected)
            if (hit.isSure) sure = std::min(sure, hit.distance);
        if (!ray.containsIntersections())
        {
            EXPECT_EQ(sure, INFINITY) << "nothing is hit";
            return;
        }
        const osgUtil::LineSegmentIntersector::Intersection hit = ray.getFirstIntersection();
        const double distance = (hit.getWorldIntersectPoint() - ray.getStart()).length();
        EXPECT_LE(distance, sure + tolerance);
        const std::optional<PickedJoint> picked = jointOf(hit);
        ASSERT_TRUE(picked);
        EXPECT_EQ(picked->crowd, crowd);
        EXPECT_EQ(picked->character, crowd ? nullptr : character);
        bool isThere = false;
        for (const PosedTriangles::Hit& candidate : expected)
            isThere = isThere ||
                      (std::abs(candidate.distance - distance) <= tolerance && candidate.owner == picked->instance &&
                       candidate.joints.count(static_cast<int>(picked->joint)) > 0);
        EXPECT_TRUE(isThere) << "hit at " << distance << ", joint " << picked->joint << ", nearest sure " << sure;
        ++hits;
    }

    std::mt19937 random{seed};
    osg::ref_ptr<osg::Node> node;
    AnimatedCharacter* character = nullptr;
    osg::ref_ptr<osg::MatrixTransform> scene;
    int hits = 0;
};

TEST_P(PickingTest, raysMeetACharacterAsItIsPosed)
{
    if (file().empty()) GTEST_SKIP() << "there is no " << GetParam().shared;
    ASSERT_NO_FATAL_FAILURE(load());
    for (int pose = 0; pose < poses; ++pose)
    {
        playAnything(character->getController());
        character->update(0.0);
        const PosedTriangles triangles = trianglesOfCharacter();
        for (int i = 0; i < raysAPose; ++i)
        {
            SCOPED_TRACE(testing::Message() << "pose " << pose << ", ray " << i << ", seed " << seed);
            check(*ray(triangles), triangles, nullptr);
        }
    }
    EXPECT_GE(hits, poses * raysAPose / 4) << "rays that hit nothing say little";
}

TEST_P(PickingTest, raysMeetACrowdsInstancesAsTheyArePosed)
{
    if (file().empty()) GTEST_SKIP() << "there is no " << GetParam().shared;
    ASSERT_NO_FATAL_FAILURE(load());
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    scene->replaceChild(node, crowd);
    PosedTriangles triangles;
    const double apart = 1.2 * static_cast<double>(character->getBound().radius());
    for (int i = 0; i < 12; ++i)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        playAnything(controller);
        const osg::Matrixd placement = osg::Matrixd::scale(osg::Vec3d(1, 1, 1) * number(0.5, 1.5)) *
                                       osg::Matrixd::rotate(number(0.0, 6.0), direction()) *
                                       osg::Matrixd::translate(apart * (i % 4), apart * (i / 4), number(-1, 1));
        const AnimatedCrowd::Instance instance = crowd->add(placement, controller).value();
        const osg::Matrixd toWorld = crowd->getFileToNode() * placement * scene->getMatrix();
        forEachMesh([&](const SkinnedGeometry& mesh) { triangles.add(mesh, controller, toWorld, instance); });
    }
    crowd->update(0.0);
    for (int i = 0; i < poses * raysAPose; ++i)
    {
        SCOPED_TRACE(testing::Message() << "ray " << i << ", seed " << seed);
        check(*ray(triangles), triangles, crowd);
    }
    EXPECT_GE(hits, poses * raysAPose / 4) << "rays that hit nothing say little";
}

/// A box around a point of the mesh contains it, so it hits the character; the joint is that of the nearest vertex.
TEST_P(PickingTest, polytopesMeetACharacterAsItIsPosed)
{
    if (file().empty()) GTEST_SKIP() << "there is no " << GetParam().shared;
    ASSERT_NO_FATAL_FAILURE(load());
    for (int pose = 0; pose < poses; ++pose)
    {
        playAnything(character->getController());
        character->update(0.0);
        const PosedTriangles triangles = trianglesOfCharacter();
        const double half = 1e-3 * triangles.size();
        const osg::Vec3d point = triangles.points()[random() % triangles.points().size()];
        for (const bool isThere : {true, false})
        {
            SCOPED_TRACE(testing::Message() << "pose " << pose << (isThere ? "" : ", far off") << ", seed " << seed);
            const osg::Vec3d centre = isThere ? point : point + direction() * 2.0 * triangles.size();
            osg::Polytope box;
            for (const osg::Vec3d axis : {osg::X_AXIS, osg::Y_AXIS, osg::Z_AXIS})
                for (const double side : {-1.0, 1.0})
                    box.add(osg::Plane(axis * side, half - axis * side * centre));
            const osg::ref_ptr<osgUtil::PolytopeIntersector> intersector = new osgUtil::PolytopeIntersector(box);
            osgUtil::IntersectionVisitor visitor(intersector);
            scene->accept(visitor);
            ASSERT_EQ(intersector->containsIntersections(), isThere);
            if (!isThere) continue;
            const std::optional<PickedJoint> picked = jointOf(intersector->getFirstIntersection());
            ASSERT_TRUE(picked);
            EXPECT_EQ(picked->character, character);
            EXPECT_LT(picked->joint, character->getAnimationSet().skeleton().jointCount());
        }
    }
}

const PickedModel pickedModels[] = {
    {"Fox", "assets/Fox/Fox.glb", nullptr},
    {"CesiumMan", "assets/CesiumMan/CesiumMan.glb", nullptr},
    {"Knight", "assets/Knight/Knight.glb", nullptr},
    {"MorphCube", "assets/AnimatedMorphCube/AnimatedMorphCube.gltf", nullptr},
    {"Wanderer", nullptr, "Wanderer.glb"},
    {"Serpent", nullptr, "Serpent.glb"},
};

INSTANTIATE_TEST_SUITE_P(Models, PickingTest, ::testing::ValuesIn(pickedModels),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace osgGpuAnimation
