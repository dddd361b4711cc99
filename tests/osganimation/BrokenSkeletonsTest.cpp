// SPDX-License-Identifier: MIT
#include "osganimation/SkeletonConversion.h"
#include "osganimation/SmallRig.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>

#include <functional>

namespace osgGpuAnimation
{

namespace
{

using Bones = std::vector<osg::ref_ptr<osg::Group>>;

/// Bones in one another below a bone; a bone is `times` times the child of the one above. Taken apart one by one.
struct BoneChain
{
    BoneChain(osgAnimation::Bone& top, std::size_t count, unsigned int times)
    {
        bones.push_back(&top);
        for (std::size_t i = 0; i < count; ++i)
            bones.push_back(new osgAnimation::Bone("bone " + std::to_string(i)));
        for (std::size_t i = count; i > 0; --i) // the innermost first: counts of children pass up one level
            for (unsigned int time = 0; time < times; ++time)
                bones[i - 1]->addChild(bones[i]);
    }
    ~BoneChain()
    {
        for (; bones.size() > 1; bones.pop_back())
            bones[bones.size() - 2]->removeChild(bones.back());
    }
    Bones bones;
};

struct SkeletonCase
{
    const char* name;
    std::size_t depth;
    unsigned int times;
    const char* fault;
};

const SkeletonCase skeletonCases[] = {
    {"30,000 nested bones", 30'000, 1, " nodes above it"},
    {"millions of paths", 22, 2, "more than 1000000 paths lead to its groups"},
};

TEST(BrokenSkeletonsTest, theyStayAsTheyAre)
{
    for (const SkeletonCase& each : skeletonCases)
    {
        SCOPED_TRACE(each.name);
        const SmallRig rig;
        const BoneChain chain(*rig.lower, each.depth, each.times);
        const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
        EXPECT_TRUE(made.characters.empty());
        ASSERT_FALSE(made.warnings.empty());
        EXPECT_NE(made.warnings.back().find(each.fault), std::string::npos) << made.warnings.back();
        EXPECT_NE(made.warnings.back().find("it stays as it is"), std::string::npos) << made.warnings.back();
    }
}

TEST(BrokenSkeletonsTest, aBoneBelowItselfIsNamed)
{
    const SmallRig rig;
    rig.lower->addChild(rig.upper);
    const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
    EXPECT_TRUE(made.characters.empty());
    EXPECT_EQ(made.warnings,
              std::vector<std::string>{"skeleton \"arm\": node \"upper\" is below itself; it stays as it is"});
    rig.lower->removeChild(rig.upper);
}

TEST(BrokenSkeletonsTest, aMissingPrimitiveSetCostsItself)
{
    const SmallRig rig;
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setName("odd");
    geometry->setVertexArray(new osg::Vec3Array(3));
    geometry->getPrimitiveSetList() = {nullptr, new osg::DrawArrays(GL_TRIANGLES, 0, 3)};
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(geometry);
    rig.lower->addChild(geode);
    const osganimation::Conversion made = osganimation::convertOsgAnimation(*rig.root);
    ASSERT_EQ(made.characters.size(), 1u);
    int found = 0;
    for (unsigned int child = 0; child < made.characters[0]->getNumChildren(); ++child)
        if (const auto* const mesh = dynamic_cast<const osg::Geometry*>(made.characters[0]->getChild(child)))
            if (mesh->getName() == "odd" && mesh->getNumPrimitiveSets() == 1u) ++found;
    EXPECT_EQ(found, 1);
    EXPECT_EQ(made.warnings,
              std::vector<std::string>{"mesh \"odd\": a primitive set is missing or has indices beyond its "
                                       "vertices; left out"});
}

} // namespace

} // namespace osgGpuAnimation
