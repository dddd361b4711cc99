// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/VertexDistance.h"

#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/LOD>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// A body of two joints wears sleeves: tubes like its own arm. Whatever a sleeve's file says, a worn sleeve that is
// bound like the arm is posed like the arm.

namespace osgGpuAnimation
{

namespace
{

/// turn: about +Z, radians.
Joint joint(const char* name, int parent, float x, float turn = 0.0f)
{
    Joint made{name, parent, {}, -1};
    made.rest.translation.x = x;
    made.rest.rotation = {0.0f, 0.0f, std::sin(0.5f * turn), std::cos(0.5f * turn)};
    return made;
}

/// A sleeve from a file of its own: joints and binds of the two halves of the tube.
struct Sleeve
{
    const char* name;
    std::vector<Joint> joints = {joint("shoulder", -1, 0), joint("elbow", 0, 4)}; ///< of its file
    std::size_t addedEntries = 0;
    int upper = 0, lower = 1; ///< joints that move the halves
    float scale = 1;          ///< of the mesh at bind time
    float rounding = 0;       ///< of the inverse binds
    float shift = 0;          ///< of the lower joint's bind matrix along +X, from its place at rest
    std::vector<std::string> followed{};
};

const Sleeve same{"the same joints"};
const Sleeve renamed{
    "another order, names with a namespace",
    {joint("rig", -1, 0), joint("hand", 3, 2), joint("coat:shoulder", 0, 0), joint("coat:elbow", 2, 4)},
    0,
    2,
    3};
const Sleeve rounded{"other rounding", same.joints, 0, 0, 1, 1, 1e-6f};
const Sleeve scaled{"another scale at bind time", same.joints, 2, 0, 1, 100};
const Sleeve buttoned{
    "turned joints that the body lacks",
    {joint("shoulder", -1, 0), joint("elbow", 0, 4), joint("cuff", 1, 3, 0.5f), joint("button", 2, 0.5f, -1.2f)},
    0,
    0,
    3,
    1,
    0,
    0,
    {"button"}};
const Sleeve* const sleeves[] = {&same, &renamed, &rounded, &scaled, &buttoned};

osg::ref_ptr<AnimatedCharacter> makeSleeve(const Sleeve& sleeve)
{
    AnimationParts parts{Skeleton::create(sleeve.joints).value(), {}, {}, {}, {}};
    const auto jointOf = [&](int input) { return parts.skeleton.jointOfInput(static_cast<std::size_t>(input)); };
    glm::dmat4 lowerToModel(1.0);
    for (int above = jointOf(sleeve.lower); above >= 0;
         above = parts.skeleton.joint(static_cast<std::size_t>(above)).parent)
        lowerToModel = parts.skeleton.joint(static_cast<std::size_t>(above)).rest.toMatrix().toColumns() * lowerToModel;
    const glm::dmat4 size = glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / sleeve.scale));
    const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), glm::dvec3(sleeve.shift, 0.0, 0.0));
    AffineMatrix upper = AffineMatrix::fromColumns(size);
    AffineMatrix lower = AffineMatrix::fromColumns(glm::inverse(lowerToModel) * shifted * size);
    upper.rows[1].x = sleeve.rounding;
    lower.rows[2].w += sleeve.rounding;
    parts.skins.push_back({"sleeve", {jointOf(sleeve.upper), jointOf(sleeve.lower)}, {upper, lower}});
    const auto set = AnimationSet::create(std::move(parts)).value();
    const osg::ref_ptr<SkinnedGeometry> tube = makeShownTube(*set);
    for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*tube->getVertexArray()))
        vertex *= sleeve.scale;
    // In the last two of four influences.
    const osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(*tube->getEntries(0));
    const osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(*tube->getWeights(0));
    for (std::size_t vertex = 0; vertex < entries->size(); ++vertex)
        for (int influence = 0; influence < 2; ++influence)
        {
            std::swap((*entries)[vertex][influence], (*entries)[vertex][influence + 2]);
            std::swap((*weights)[vertex][influence], (*weights)[vertex][influence + 2]);
        }
    tube->setInfluences(0, entries, weights);
    tube->setName("sleeve");
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    character->addChild(tube);
    return character;
}

osg::ref_ptr<AnimatedCharacter> makeBody(bool hasMorph = false)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeTubeCharacter(armSet(hasMorph));
    body->getChild(0)->setName("arm");
    body->getController().seek(0.7);
    return body;
}

SkinnedGeometry& meshAt(const osg::Group& group, unsigned int child)
{
    return dynamic_cast<SkinnedGeometry&>(*const_cast<osg::Node*>(group.getChild(child)));
}

/// The largest distance of the two meshes of a character, as posed.
double distanceOfMeshes(const AnimatedCharacter& character)
{
    return largestDistance(*character.getPosedMesh(meshAt(character, 0)),
                           *character.getPosedMesh(meshAt(character, 1)));
}

} // namespace

TEST(GarmentTest, isPosedLikeTheBody)
{
    for (const Sleeve* sleeve : sleeves)
    {
        SCOPED_TRACE(sleeve->name);
        const osg::ref_ptr<AnimatedCharacter> body = makeBody(), garment = makeSleeve(*sleeve);
        const std::shared_ptr<const AnimationSet> before = body->getController().sharedSet();
        const double time = body->getController().time();
        const Result<WornGarment> worn = body->wear(garment);
        ASSERT_TRUE(worn) << worn.error().message;
        EXPECT_EQ(worn.value().addedEntries, sleeve->addedEntries);
        EXPECT_EQ(worn.value().followed, sleeve->followed);
        EXPECT_EQ(body->getAnimationSet().paletteSize(), before->paletteSize() + sleeve->addedEntries);
        EXPECT_EQ(body->getController().sharedSet() == before, sleeve->addedEntries == 0);
        EXPECT_EQ(body->getController().time(), time);
        ASSERT_EQ(body->getNumChildren(), 2u);
        EXPECT_NE(body->getChild(1), garment->getChild(0)) << "the garment stays what it was";
        EXPECT_EQ(garment->getNumChildren(), 1u);
        EXPECT_LT(distanceOfMeshes(*body), 8.0 * 1e-6);
        EXPECT_TRUE(body->takeOff(garment));
        EXPECT_FALSE(body->takeOff(garment));
        EXPECT_EQ(body->getNumChildren(), 1u);
        EXPECT_EQ(body->getController().sharedSet(), before);
    }
}

TEST(GarmentTest, ofRigidPartsFollowsTheirJoints)
{
    AnimationParts parts{Skeleton::create(renamed.joints).value(), {}, {}, {}, {}};
    const int elbow = parts.skeleton.findJoint("coat:elbow");
    parts.rigidJoints = {elbow};
    const auto set = AnimationSet::create(std::move(parts)).value();
    const osg::ref_ptr<AnimatedCharacter> shield = new AnimatedCharacter(set);
    const osg::ref_ptr<SkinnedGeometry> mesh = makeTube(*armSet());
    mesh->setRigidEntry(static_cast<unsigned short>(set->entryOfRigidJoint(elbow)));
    shield->addChild(mesh);
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(), coat = makeSleeve(scaled);
    const Result<WornGarment> worn = body->wear(shield);
    ASSERT_TRUE(worn) << worn.error().message;
    EXPECT_EQ(worn.value().addedEntries, 1u) << "the body has no rigid mesh on its elbow";
    const osg::Matrixd elbowToModel = body->jointToModel("elbow").value();
    const osg::ref_ptr<osg::Geometry> posed = body->getPosedMesh(meshAt(*body, 1));
    const auto& bind = static_cast<const osg::Vec3Array&>(*mesh->getVertexArray());
    for (std::size_t i = 0; i < bind.size(); ++i)
        ASSERT_LT((static_cast<const osg::Vec3Array&>(*posed->getVertexArray())[i] - bind[i] * elbowToModel).length(),
                  1e-5);
    ASSERT_TRUE(body->wear(coat));
    EXPECT_TRUE(body->takeOff(coat));
    EXPECT_EQ(body->getAnimationSet().paletteSize(), armSet()->paletteSize() + 1) << "the shield's entry remains";
    EXPECT_LT(largestDistance(*body->getPosedMesh(meshAt(*body, 1)), *posed), 1e-6);
}

TEST(GarmentTest, thatCannotBeWornLeavesTheBodyAlone)
{
    const Sleeve strange{"strange", {joint("root", -1, 0), joint("tail", 0, 4)}};
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(), worn = makeSleeve(same);
    ASSERT_TRUE(body->wear(worn));
    struct
    {
        osg::ref_ptr<osg::Node> garment;
        const char* message;
    } const cases[] = {
        {nullptr, "the garment has no animated character"},
        {new osg::Group, "the garment has no animated character"},
        {body, "the garment has no animated character"},
        {new AnimatedCharacter(armSet()), "the garment has no meshes that joints move"},
        {worn, "the character wears the garment already"},
        {makeSleeve(strange), "the character has no joints \"root\", \"tail\", nor any joint that is above them in the "
                              "garment; its joints are \"shoulder\", \"elbow\""},
    };
    for (const auto& bad : cases)
    {
        const Result<WornGarment> result = body->wear(bad.garment.get());
        ASSERT_FALSE(result) << bad.message;
        EXPECT_EQ(result.error().message, bad.message);
        EXPECT_EQ(body->getNumChildren(), 2u);
    }
    const std::pair<const osg::Node*, const char*> notWorn[] = {
        {nullptr, "there is no garment to take off"},
        {body->getChild(0), "the character does not wear \"arm\"; the meshes of its garments are \"sleeve\""}};
    for (const auto& [garment, message] : notWorn)
    {
        const Result<void> taken = body->takeOff(garment);
        ASSERT_FALSE(taken) << message;
        EXPECT_EQ(taken.error().message, message);
    }
}

TEST(GarmentTest, isSharedByAllWhoWearIt)
{
    for (const Sleeve* sleeve : sleeves)
    {
        SCOPED_TRACE(sleeve->name);
        const osg::ref_ptr<AnimatedCharacter> first = makeBody(), garment = makeSleeve(*sleeve);
        const osg::ref_ptr<AnimatedCharacter> second = cloneOf(*first);
        ASSERT_TRUE(first->wear(garment));
        const osg::ref_ptr<AnimatedCharacter> dressed = cloneOf(*first);
        const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_ALL);
        ASSERT_TRUE(second->wear(cloneOf(*garment)));
        for (const AnimatedCharacter* other : {second.get(), dressed.get()})
        {
            EXPECT_EQ(other->getController().sharedSet(), first->getController().sharedSet());
            EXPECT_EQ(other->getChild(0), first->getChild(0));
            EXPECT_EQ(other->getChild(1), first->getChild(1));
        }
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
        const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), first->getController()).value();
        EXPECT_LT(
            largestDistance(*crowd->getPosedMesh(instance, meshAt(*crowd, 1)), *first->getPosedMesh(meshAt(*first, 0))),
            8.0 * 1e-6);
        for (AnimatedCharacter* other : {dressed.get(), copy.get()})
        {
            EXPECT_TRUE(other->takeOff(garment));
            EXPECT_EQ(other->getNumChildren(), 1u);
        }
        EXPECT_EQ(first->getNumChildren(), 2u);
    }
}

TEST(GarmentTest, takenOffLeavesTheOthers)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeBody();
    const std::shared_ptr<const AnimationSet> bare = body->getController().sharedSet();
    Sleeve thick = scaled;
    thick.scale = 10;
    const osg::ref_ptr<AnimatedCharacter> coat = makeSleeve(scaled), shirt = makeSleeve(thick),
                                          badge = makeSleeve(same);
    ASSERT_TRUE(body->wear(shirt));
    ASSERT_TRUE(body->wear(coat));
    EXPECT_EQ(body->getAnimationSet().paletteSize(), 6u);
    EXPECT_TRUE(body->takeOff(shirt));
    EXPECT_EQ(body->getAnimationSet().paletteSize(), 6u) << "the coat has its entries after the shirt's";
    EXPECT_LT(distanceOfMeshes(*body), 8.0 * 1e-6);
    EXPECT_TRUE(body->takeOff(body->getChild(1))) << "by the garment's mesh";
    EXPECT_EQ(body->getController().sharedSet(), bare);
    ASSERT_TRUE(body->wear(shirt));
    ASSERT_TRUE(coat->wear(badge));
    ASSERT_TRUE(body->wear(coat));
    EXPECT_EQ(body->getNumChildren(), 4u) << "the coat and the badge that it wears";
    EXPECT_FALSE(body->takeOff(badge)) << "it is the coat's";
    EXPECT_TRUE(body->takeOff(coat));
    EXPECT_EQ(body->getNumChildren(), 2u);
    EXPECT_EQ(body->getAnimationSet().paletteSize(), 4u);
    EXPECT_LT(distanceOfMeshes(*body), 8.0 * 1e-6);
    EXPECT_TRUE(coat->takeOff(badge));
}

TEST(GarmentTest, belongsToTheBoundsAndIsPicked)
{
    Sleeve wide = scaled;
    wide.scale = 1;
    wide.shift = 1; // its lower half lies 1 unit farther out
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(), garment = makeSleeve(wide);
    for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*meshAt(*garment, 0).getVertexArray()))
        vertex = osg::Vec3(vertex.x(), 2 * vertex.y(), 2 * vertex.z());
    const osg::BoundingBox before = body->getCurrentBounds();
    ASSERT_TRUE(body->wear(garment));
    const osg::BoundingBox now = body->getCurrentBounds();
    EXPECT_GT(now.yMax(), before.yMax() + 0.5f);
    EXPECT_GT(body->getBound().radius(), osg::BoundingSphere(before).radius() + 0.1f);
    const osg::ref_ptr<osg::Geometry> posed = body->getPosedMesh(meshAt(*body, 1));
    for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(*posed->getVertexArray()))
        EXPECT_TRUE(now.contains(vertex, 1e-4f));
    body->getController().seek(0.0);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*body);
    const AnimatedCrowd::Instance instance =
        crowd->add(osg::Matrixd::translate(0, 0, 50), body->getController()).value();
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(body);
    scene->addChild(crowd);
    for (const double height : {0.0, 50.0})
    {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
            new osgUtil::LineSegmentIntersector(osg::Vec3d(7, -20, height + 0.1), osg::Vec3d(7, 20, height + 0.1));
        osgUtil::IntersectionVisitor visitor(ray);
        scene->accept(visitor);
        ASSERT_TRUE(ray->containsIntersections());
        const auto hit = ray->getFirstIntersection();
        EXPECT_EQ(hit.drawable.get(), body->getChild(1));
        const std::optional<PickedJoint> picked = jointOf(hit);
        ASSERT_TRUE(picked);
        EXPECT_EQ(picked->set->skeleton().joint(picked->joint).name, "elbow");
        EXPECT_EQ(instanceOf(hit) == instance, height > 0.0);
    }
    EXPECT_TRUE(body->takeOff(garment));
    body->getController().seek(0.7);
    EXPECT_EQ(body->getCurrentBounds(), before);
}

TEST(GarmentTest, morphsWithTheBodysWeights)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(true), garment = makeBody(true), plain = makeBody(false);
    const Result<WornGarment> worn = body->wear(garment);
    ASSERT_TRUE(worn);
    EXPECT_TRUE(worn.value().leftOut.empty());
    EXPECT_EQ(worn.value().addedEntries, 0u);
    EXPECT_LT(distanceOfMeshes(*body), 1e-6);
    const Result<WornGarment> without = plain->wear(garment);
    ASSERT_TRUE(without);
    EXPECT_EQ(without.value().leftOut, std::vector<std::string>{"thick"});
    EXPECT_LT(distanceOfMeshes(*plain), 1e-6) << "the shape without weights";
}

TEST(GarmentTest, showsVariantsOfItsMaterials)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(), garment = makeSleeve(same);
    const osg::ref_ptr<osg::StateSet> plain = meshAt(*garment, 0).getStateSet(), red = new osg::StateSet;
    setVariantStates(meshAt(*garment, 0), plain, {{"red", red}});
    ASSERT_TRUE(body->wear(garment));
    EXPECT_EQ(body->getMeshes().getVariants(), std::vector<std::string>{"red"});
    ASSERT_TRUE(body->getMeshes().setVariant("red"));
    EXPECT_EQ(body->getChild(1)->getStateSet(), red);
    EXPECT_EQ(garment->getChild(0)->getStateSet(), plain);
    EXPECT_TRUE(body->takeOff(garment)) << "in another variant it is the same garment";
    ASSERT_TRUE(body->wear(garment));
    EXPECT_EQ(body->getChild(1)->getStateSet(), red) << "the variant of the body when it is put on";
    EXPECT_EQ(cloneOf(*body)->getMeshes().getVariant(), "red");
}

TEST(MeshNamesTest, nodesAreFoundBeforeMeshes)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeBody();
    for (const auto& [node, mesh] :
         {std::pair("Sword", "Plane"), std::pair("Cube", "Sword"), std::pair("Cube", "Cube")})
    {
        const osg::ref_ptr<SkinnedGeometry> part = makeShownTube(body->getAnimationSet());
        part->setName(node);
        setMeshName(*part, mesh);
        body->addChild(part);
    }
    const std::pair<const char*, osg::Node*> found[] = {{"arm", body->getChild(0)},
                                                        {"Sword", body->getChild(1)},
                                                        {"Cube", body->getChild(2)},
                                                        {"Plane", body->getChild(1)}, // a mesh's name
                                                        {"Shield", nullptr}};
    for (const auto& [name, mesh] : found)
        EXPECT_EQ(body->getMeshes().find(name), mesh) << name;
    const Result<void> hidden = body->getMeshes().setVisible("Shield", false);
    ASSERT_FALSE(hidden);
    EXPECT_EQ(hidden.error().message, "there is no mesh \"Shield\"; the meshes are \"arm\", \"Sword\", \"Cube\"");
}

TEST(MeshNamesTest, clonesShowMeshesOfTheirOwn)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(), second = cloneOf(*body), third = cloneOf(*body);
    osg::Node* const shown = body->getChild(0);
    shown->setNodeMask(0xF0);
    const osg::BoundingBox bounds = body->getCurrentBounds();
    ASSERT_TRUE(second->getMeshes().setVisible("arm", false));
    ASSERT_TRUE(third->getMeshes().setVisible("arm", false));
    EXPECT_EQ(body->getChild(0), shown);
    EXPECT_EQ(shown->getNodeMask(), 0xF0u);
    EXPECT_EQ(second->getChild(0)->getNodeMask(), 0u);
    EXPECT_EQ(second->getChild(0), third->getChild(0)) << "who hides the same is drawn together";
    second->computeClipBounds();
    EXPECT_EQ(second->getCurrentBounds(), bounds) << "it may be shown at any time";
    ASSERT_TRUE(second->getMeshes().setVisible("arm", true));
    EXPECT_EQ(second->getChild(0), shown);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*third);
    EXPECT_EQ(crowd->getChild(0)->getNodeMask(), 0u);
    for (const bool isVisible : {true, false, true, false})
    {
        ASSERT_TRUE(second->getMeshes().setVisible("arm", isVisible));
        ASSERT_TRUE(crowd->getMeshes().setVisible("arm", isVisible));
        EXPECT_EQ(second->getMeshes().find("arm")->getNodeMask(), isVisible ? 0xF0u : 0u) << "it keeps its mask";
        EXPECT_EQ(crowd->getMeshes().find("arm")->getNodeMask(), isVisible ? 0xF0u : 0u);
    }
    EXPECT_EQ(third->getChild(0)->getNodeMask(), 0u);
    EXPECT_FALSE(crowd->getMeshes().setVisible("leg", true));
}

// As the file's own levels of detail are: below an osg::LOD, the first one without a largest size.
TEST(MeshNamesTest, levelsOfDetailAreOneMeshThatClonesShareUntilOneChanges)
{
    const osg::ref_ptr<AnimatedCharacter> body = makeBody(), other = makeBody();
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
    const osg::ref_ptr<SkinnedGeometry> hand = makeShownTube(body->getAnimationSet()),
                                        fromAfar = makeShownTube(body->getAnimationSet());
    const osg::ref_ptr<osg::StateSet> red = new osg::StateSet;
    setVariantStates(*hand, hand->getStateSet(), {{"red", red}});
    hand->setName("hand");
    levels->addChild(hand, 100.0f, std::numeric_limits<float>::max());
    levels->addChild(fromAfar, 0.0f, 100.0f);
    body->addChild(levels);
    EXPECT_EQ(body->getMeshes().find("hand"), hand);
    const osg::ref_ptr<AnimatedCharacter> hidden = osg::clone(body.get()), painted = osg::clone(body.get());
    ASSERT_TRUE(hidden->getMeshes().setVisible("arm", false));
    EXPECT_EQ(hidden->getChild(1), levels);
    for (const bool isVisible : {false, true, false})
    {
        ASSERT_TRUE(hidden->getMeshes().setVisible("hand", isVisible));
        const osg::Group& ofHidden = *hidden->getChild(1)->asGroup();
        for (unsigned int level = 0; level < 2; ++level)
            EXPECT_EQ(ofHidden.getChild(level)->getNodeMask() != 0, isVisible) << level;
    }
    ASSERT_TRUE(painted->getMeshes().setVariant("red"));
    EXPECT_EQ(body->getMeshes().find("hand"), hand);
    EXPECT_EQ(levels->getChild(0), hand);
    EXPECT_NE(hand->getNodeMask(), 0u);
    EXPECT_EQ(painted->getMeshes().find("hand")->getStateSet(), red);
    ASSERT_TRUE(other->wear(body));
    EXPECT_EQ(other->getNumChildren(), 3u) << "the first level is worn";
    EXPECT_NE(other->getMeshes().find("hand"), nullptr);
    EXPECT_TRUE(other->takeOff(body));
}

} // namespace osgGpuAnimation
