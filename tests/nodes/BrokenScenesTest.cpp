// SPDX-License-Identifier: MIT
// Scenes that no program should make: cycles, millions of paths, depths beyond the call stack. The kit's own traversals
// end; OSG's own do not on all of them.
#include "support/TestCrowd.h"

#include <osgGpuAnimation/nodes/studio/ModelExtent.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Geometry>

#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Groups in one another, the outermost last, with a node in the innermost. It takes them apart one by one: OSG's
/// destructors recurse.
struct Nested
{
    Nested(std::size_t count, osg::Node* innermost, unsigned int times = 1)
    {
        for (std::size_t i = 0; i < count; ++i)
        {
            groups.push_back(new osg::Group);
            for (unsigned int time = 0; time < times; ++time)
                groups[i]->addChild(i > 0 ? groups[i - 1].get() : innermost);
        }
    }
    ~Nested()
    {
        for (; !groups.empty(); groups.pop_back())
            groups.back()->removeChildren(0, groups.back()->getNumChildren());
    }
    osg::Group& outermost() const { return *groups.back(); }

    std::vector<osg::ref_ptr<osg::Group>> groups;
};

/// Counts drawables.
class Counter : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    explicit Counter(Shared shared) : SceneVisitor(shared, TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable&) override { ++count; }
    std::size_t count = 0;
};

struct ScenesCase
{
    const char* name;
    std::size_t depth;
    unsigned int times; ///< a group is child of the next one
    std::size_t onceCount, pathCount;
    std::string onceFault, pathFault;
};

const std::string tooDeep =
    "node \"\" has more than " + std::to_string(SceneGuard::maxRecursion - 1) + " nodes above it";
const ScenesCase scenesCases[] = {
    {"the deepest that is visited", SceneGuard::maxRecursion, 1, 1, 1, "", ""},
    {"deeper", 100'000, 1, 0, 0, tooDeep, tooDeep},
    {"a thousand paths", 10, 2, 1 * 2, 1024, "", ""},
    {"millions of paths", 22, 2, 1 * 2, 2 * 499'986, "", "more than 1000000 paths lead to its groups"},
};

TEST(BrokenScenesTest, visitorsOfTheKitEnd)
{
    for (const ScenesCase& each : scenesCases)
    {
        SCOPED_TRACE(each.name);
        const osg::ref_ptr<osg::Geometry> leaf = new osg::Geometry;
        const Nested nested(each.depth, leaf, each.times);
        Counter once(SceneVisitor::Shared::Once), paths(SceneVisitor::Shared::EachPath);
        nested.outermost().accept(once);
        nested.outermost().accept(paths);
        EXPECT_EQ(once.count, each.onceCount);
        EXPECT_NEAR(static_cast<double>(paths.count), static_cast<double>(each.pathCount), 40.0);
        EXPECT_EQ(once.guard().fault(), each.onceFault);
        EXPECT_EQ(paths.guard().fault(), each.pathFault);
    }
}

TEST(BrokenScenesTest, aGroupBelowItselfIsVisitedOnce)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const osg::ref_ptr<osg::Group> outer = new osg::Group, inner = new osg::Group;
    outer->setName("outer");
    outer->addChild(inner);
    inner->addChild(new osg::Geometry);
    EXPECT_EQ(findCharacter(*outer), nullptr);
    outer->addChild(character); // before the cycle, in which OSG would count callbacks without end
    inner->addChild(outer);
    for (const SceneVisitor::Shared shared : {SceneVisitor::Shared::Once, SceneVisitor::Shared::EachPath})
    {
        Counter counter(shared);
        outer->accept(counter);
        EXPECT_EQ(counter.count, 2u);
        EXPECT_EQ(counter.guard().fault(),
                  shared == SceneVisitor::Shared::Once ? "" : "node \"outer\" is below itself");
    }
    EXPECT_EQ(findAbove(*inner, [](const osg::Node&) { return false; }), nullptr);
    EXPECT_EQ(findCharacter(*inner), character.get());
    inner->removeChild(outer);
}

TEST(BrokenScenesTest, charactersBelowAreNotFoundAndThoseAboveKeepTheirOwnMeshes)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const osg::BoundingBox bounds = character->getClipBounds(0);
    const Nested deep(100'000, makeTestSquare(2)), wide(22, makeTestSquare(1), 2);
    for (const Nested* each : {&deep, &wide})
    {
        EXPECT_EQ(findCharacter(each->outermost()), nullptr);
        character->addChild(&each->outermost());
        character->computeClipBounds();
        EXPECT_EQ(character->getClipBounds(0).corner(7), bounds.corner(7));
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        EXPECT_EQ(crowd->getNumChildren(), 1u) << "its direct meshes";
        character->removeChild(&each->outermost());
    }
    const Nested above(100'000, character);
    EXPECT_EQ(findCharacter(above.outermost()), nullptr);
}

TEST(BrokenScenesTest, primitiveSetsBeyondTheVerticesAreNotRead)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeTestSquare(1);
    osg::Geometry::PrimitiveSetList& sets = square->getPrimitiveSetList();
    sets.insert(sets.begin(), {nullptr, new osg::DrawArrays(GL_TRIANGLES, 0, 2'000'000'000)});
    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(testCharacterSet());
    character->addChild(square);
    EXPECT_TRUE(character->getMeshes().setPixelError(1.0f));
    character->getMeshes().waitForLevels();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    EXPECT_TRUE(crowd->getMeshes().setPixelError(1.0f));
    crowd->getMeshes().waitForLevels();
    EXPECT_TRUE(crowd->getMeshes().setPixelError(2.0f));
    crowd->getMeshes().waitForLevels();
    EXPECT_EQ(character->getPosedMesh(*square)->getNumPrimitiveSets(), 1u);
}

TEST(BrokenScenesTest, studiosMeasureWhatIsSound)
{
    const osg::ref_ptr<osg::Group> studio = new osg::Group, cycle = new osg::Group;
    const osg::ref_ptr<osg::Geometry> box = new osg::Geometry;
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 2, 3}};
    box->setVertexArray(new osg::Vec3Array(2, corners));
    box->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 2));
    studio->addChild(box);
    studio->addChild(cycle);
    cycle->addChild(box);
    cycle->addChild(cycle);
    EXPECT_EQ(extentOf(*studio).corner(7), osg::Vec3d(1, 2, 3));
    EXPECT_EQ(pointsOf(*studio).size(), 4u);
    cycle->removeChildren(0, 2);
    const Nested deep(100'000, box), wide(22, box, 2);
    for (const Nested* each : {&deep, &wide})
    {
        EXPECT_TRUE(studio->addChild(&each->outermost()));
        EXPECT_EQ(extentOf(*studio).corner(7), osg::Vec3d(1, 2, 3));
        EXPECT_GE(pointsOf(*studio).size(), 2u);
        studio->removeChild(&each->outermost());
    }
}

} // namespace

} // namespace osgGpuAnimation
