// SPDX-License-Identifier: MIT
#include "gltf/ModelImport.h"
#include "plugin/PluginFolder.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <gtest/gtest.h>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/IntersectionVisitor>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <vector>

// Compares 300 random rays per model with the triangles in the CPU twin's pose, at random times, in crossfades and with
// layers, below transforms that rotate and scale, for a single character and for a crowd.

namespace osgGpuAnimation
{

namespace
{

/// Meshes as plain geometry, posed by the CPU twin: OSG's own intersection is the reference.
class PlainScene
{
public:
    /// mesh: as the controller poses it. toWorld: from the file's axes. owner: of the mesh in a crowd.
    void add(const SkinnedGeometry& mesh, const AnimationController& controller, const osg::Matrixd& toWorld,
             AnimatedCrowd::Instance owner = 0)
    {
        std::vector<AffineMatrix> palette;
        Pose::evaluate(controller.set(), controller.instruction(), AffineMatrix(), palette);
        std::vector<glm::dvec3> positions;
        mesh.computePositions(palette, positions);
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        for (const glm::dvec3& p : positions)
        {
            vertices->push_back(osg::Vec3d(p.x, p.y, p.z));
            points.push_back(osg::Vec3d(p.x, p.y, p.z) * toWorld);
            box.expandBy(points.back());
        }
        const osg::ref_ptr<osg::Geometry> plain = new osg::Geometry;
        plain->setVertexArray(vertices);
        plain->setPrimitiveSetList(mesh.getPrimitiveSetList());
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(toWorld);
        place->addChild(plain);
        root->addChild(place);
        _sources[plain] = {&mesh, &controller.set(), owner};
    }

    double size() const { return (box._max - box._min).length(); }
    AnimatedCrowd::Instance ownerOf(const osg::Drawable* plain) const { return _sources.at(plain).owner; }

    /// The heaviest joint at a hit, and any that weighs nearly as much.
    std::set<int> jointsAt(const osgUtil::LineSegmentIntersector::Intersection& hit) const
    {
        const Source& source = _sources.at(hit.drawable);
        std::map<int, double> weights;
        double most = 0.0;
        for (std::size_t corner = 0; corner < hit.indexList.size(); ++corner)
            source.mesh->forEachInfluence(hit.indexList[corner],
                                          [&](std::size_t entry, float weight)
                                          {
                                              double& sum = weights[source.set->palette()[entry].joint];
                                              sum += hit.ratioList[corner] * static_cast<double>(weight);
                                              most = std::max(most, sum);
                                          });
        std::set<int> joints;
        for (const auto& [joint, weight] : weights)
            if (weight >= most - 1e-2) joints.insert(joint);
        return joints;
    }

    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<osg::Vec3d> points; ///< all vertices, in the world
    osg::BoundingBoxd box;

private:
    struct Source
    {
        const SkinnedGeometry* mesh;
        const AnimationSet* set;
        AnimatedCrowd::Instance owner;
    };
    std::map<const osg::Drawable*, Source> _sources;
};

class PickingTest : public ::testing::TestWithParam<std::string>
{
protected:
    static constexpr unsigned int seed = 20261121;
    static constexpr int poses = 30, raysAPose = 10;

    void SetUp() override
    {
        if (modelFile(GetParam()).empty()) GTEST_SKIP() << "there is no " << GetParam();
        usePluginsOfTheBuild();
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("noKeys");
        options->setBuildKdTreesHint(osgDB::Options::BUILD_KDTREES);
        node = osgDB::readRefNodeFile(modelFile(GetParam()), options);
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

    PlainScene plainCharacter() const
    {
        PlainScene plain;
        const osg::Matrixd toWorld =
            character->getFileToNode() * osg::computeLocalToWorld(character->getParentalNodePaths().front());
        forEachMesh([&](const SkinnedGeometry& mesh) { plain.add(mesh, character->getController(), toWorld); });
        return plain;
    }

    /// A ray that starts outside the model and passes near a random point of the mesh.
    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray(const PlainScene& plain)
    {
        const osg::Vec3d target =
            plain.points[random() % plain.points.size()] + direction() * number(0.0, 0.05) * plain.size();
        const osg::Vec3d way = direction() * 2.0 * plain.size();
        return new osgUtil::LineSegmentIntersector(target - way, target + way);
    }

    /// Compares the first hits of a ray. crowd: null if the character is picked.
    void check(const PlainScene& plain, const AnimatedCrowd* crowd)
    {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> found = ray(plain);
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> expected =
            new osgUtil::LineSegmentIntersector(found->getStart(), found->getEnd());
        osgUtil::IntersectionVisitor visitor(found), plainVisitor(expected);
        scene->accept(visitor);
        plain.root->accept(plainVisitor);
        if (!found->containsIntersections() || !expected->containsIntersections())
        {
            atEdges += found->containsIntersections() != expected->containsIntersections();
            return;
        }
        const auto hit = found->getFirstIntersection(), wanted = expected->getFirstIntersection();
        const std::optional<PickedJoint> picked = jointOf(hit);
        ASSERT_TRUE(picked);
        EXPECT_EQ(picked->crowd, crowd);
        EXPECT_EQ(picked->character, crowd ? nullptr : character);
        ++hits;
        const auto isFar = [&](const auto& other)
        { return (hit.getWorldIntersectPoint() - other.getWorldIntersectPoint()).length() > 1e-4 * plain.size(); };
        atEdges += isFar(wanted);
        bool isThere = isFar(wanted);
        for (const auto& candidate : expected->getIntersections()) // surfaces may coincide
            isThere = isThere || (!isFar(candidate) && picked->instance == plain.ownerOf(candidate.drawable) &&
                                  plain.jointsAt(candidate).count(static_cast<int>(picked->joint)) > 0);
        EXPECT_TRUE(isThere) << "joint " << picked->joint;
    }

    void expectFewAtEdges() const
    {
        EXPECT_GE(hits, poses * raysAPose / 4) << "rays that hit nothing say little";
        EXPECT_LE(atEdges, poses * raysAPose / 100) << "rounding decides what these meet";
    }

    std::mt19937 random{seed};
    osg::ref_ptr<osg::Node> node;
    AnimatedCharacter* character = nullptr;
    osg::ref_ptr<osg::MatrixTransform> scene;
    int hits = 0, atEdges = 0;
};

TEST_P(PickingTest, raysMeetACharacterAsItIsPosed)
{
    for (int pose = 0; pose < poses; ++pose)
    {
        playAnything(character->getController());
        character->update(0.0);
        const PlainScene plain = plainCharacter();
        for (int i = 0; i < raysAPose; ++i)
        {
            SCOPED_TRACE(testing::Message() << "pose " << pose << ", ray " << i << ", seed " << seed);
            check(plain, nullptr);
        }
    }
    expectFewAtEdges();
}

TEST_P(PickingTest, raysMeetACrowdsInstancesAsTheyArePosed)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    scene->replaceChild(node, crowd);
    PlainScene plain;
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
        forEachMesh([&](const SkinnedGeometry& mesh) { plain.add(mesh, controller, toWorld, instance); });
    }
    crowd->update(0.0);
    for (int i = 0; i < poses * raysAPose; ++i)
    {
        SCOPED_TRACE(testing::Message() << "ray " << i << ", seed " << seed);
        check(plain, crowd);
    }
    expectFewAtEdges();
}

/// A box around a point of the mesh contains it, so it hits the character; the joint is that of the nearest vertex.
TEST_P(PickingTest, polytopesMeetACharacterAsItIsPosed)
{
    for (int pose = 0; pose < poses; ++pose)
    {
        playAnything(character->getController());
        character->update(0.0);
        const PlainScene plain = plainCharacter();
        const double half = 1e-3 * plain.size();
        const osg::Vec3d point = plain.points[random() % plain.points.size()];
        for (const bool isThere : {true, false})
        {
            SCOPED_TRACE(testing::Message() << "pose " << pose << (isThere ? "" : ", far off") << ", seed " << seed);
            const osg::Vec3d centre = isThere ? point : point + direction() * 2.0 * plain.size();
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

INSTANTIATE_TEST_SUITE_P(Models, PickingTest,
                         ::testing::Values("assets/Fox/Fox.glb", "assets/CesiumMan/CesiumMan.glb",
                                           "assets/Knight/Knight.glb",
                                           "assets/AnimatedMorphCube/AnimatedMorphCube.gltf", "Wanderer.glb",
                                           "Serpent.glb"),
                         [](const auto& info) { return gltf::nameOfFile(info.param); });

} // namespace

} // namespace osgGpuAnimation
