// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/MadeLevels.h"
#include "support/TestCrowd.h"

#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <cmath>
#include <ctime>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

LodLevels::Skinning skinningOf(const SkinnedGeometry& mesh)
{
    return [&mesh](const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& outPositions)
    { mesh.computePositions(palette, outPositions); };
}

LodLevels levelsOf(const SkinnedGeometry& mesh, const AnimationSet& set)
{
    LodLevels levels(mesh);
    levels.addSteps(mesh, set, skinningOf(mesh), nullptr);
    return levels;
}

/// The number of drawn indices of the first primitive set.
std::size_t drawn(const SkinnedGeometry& mesh, const LodLevels& levels, int level)
{
    const osg::DrawElements* elements = levels.reduced(0, level).elements;
    return (elements ? *elements : *mesh.getPrimitiveSet(0)).getNumIndices();
}

bool has(const LodLevels& levels)
{
    return levels.finest() != LodLevels::allTriangles;
}

osg::Vec3Array& positionsOf(SkinnedGeometry& mesh)
{
    return static_cast<osg::Vec3Array&>(*mesh.getVertexArray());
}

osg::DrawElementsUShort& trianglesOf(SkinnedGeometry& mesh)
{
    return static_cast<osg::DrawElementsUShort&>(*mesh.getPrimitiveSet(0));
}

TEST(LodLevelsTest, areNumberedInHalfOctaves)
{
    EXPECT_EQ(LodLevels::errorOf(0), 1.25);
    EXPECT_EQ(LodLevels::errorOf(-4), 1.25 / 4.0);
    for (int level = -60; level <= 60; ++level)
    {
        const double error = LodLevels::errorOf(level);
        EXPECT_DOUBLE_EQ(LodLevels::errorOf(level + 2), 2.0 * error);
        EXPECT_DOUBLE_EQ(LodLevels::errorOf(level + 1), std::sqrt(2.0) * error);
        EXPECT_EQ(LodLevels::levelOf(error), level);
        EXPECT_EQ(LodLevels::levelOf(1.41 * error), level);
        EXPECT_EQ(LodLevels::levelOf(0.999 * error), level - 1);
    }
    EXPECT_EQ(LodLevels::errorOf(LodLevels::allTriangles), 0.0);
    for (const double nothing : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_EQ(LodLevels::levelOf(nothing), LodLevels::allTriangles);
}

TEST(LodLevelsTest, keepAnElbowThatBendsInAClipAndFollowANewSet)
{
    const auto bending = armSet(), still = bending->withClips({}).value();
    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(still);
    const osg::ref_ptr<SkinnedGeometry> tube = makeTube(*still);
    character->addChild(tube);
    ASSERT_TRUE(character->getMeshes().setPixelError(1.0f));
    const int level = -10; // 1/32; the tube is 1 thick
    const auto drawnOf = [&](const AnimationSet& set) { return drawn(*tube, *madeLevels(*tube, set), level); };
    const std::size_t straight = drawnOf(*still);
    EXPECT_LT(straight, 300u) << "straight, it needs but its ends";
    ASSERT_TRUE(character->setAnimationSet(bending));
    EXPECT_GT(drawnOf(*bending), 2 * straight);
    EXPECT_LT(drawnOf(*bending), tube->getPrimitiveSet(0)->getNumIndices() / 4);
    EXPECT_EQ(drawn(*tube, *madeLevels(*tube, *bending), LodLevels::allTriangles), trianglesOf(*tube).size());
    ASSERT_TRUE(character->setAnimationSet(still));
    EXPECT_EQ(drawnOf(*still), straight);
}

TEST(LodLevelsTest, haveTheVolumeOfTheMesh)
{
    const std::shared_ptr<const AnimationSet> bending = armSet();
    const osg::ref_ptr<SkinnedGeometry> tube = makeTube(*bending);
    const LodLevels levels = levelsOf(*tube, *bending);
    EXPECT_EQ(levels.reduced(0, LodLevels::allTriangles).outset, 0.0f);
    EXPECT_GT(levels.reduced(0, levels.coarsest()).outset, 0.02 * std::exp2(0.5 * levels.coarsest()));
    for (int level = levels.finest(); level <= levels.coarsest(); ++level)
    {
        EXPECT_LE(std::exp2(0.5 * level) + levels.reduced(0, level).outset, LodLevels::errorOf(level)) << level;
        EXPECT_LE(levels.reduced(0, level).error, LodLevels::errorOf(level)) << level;
        EXPECT_GT(levels.reduced(0, level).error, levels.reduced(0, level).outset) << level;
    }
    for (int level : {LodLevels::allTriangles, levels.finest() - 1, levels.finest(), levels.coarsest() + 9})
        EXPECT_EQ(levels.foundError(level), levels.reduced(0, level).error) << level;
    EXPECT_EQ(levels.foundError(levels.finest() - 1), 0.0);
}

TEST(LodLevelsTest, speakOfTheCharactersUnitsWhateverTheMeshs)
{
    // The same tube, a hundred times as large in its own space and scaled down by its palette.
    AffineMatrix small;
    for (int row = 0; row < 3; ++row)
        small.rows[static_cast<std::size_t>(row)][row] = 0.01f;
    AnimationParts parts{Skeleton::create({{"root", -1, {}, 0}}).value(), {{"skin", {0}, {small}}}, {}, {}, {}};
    const auto set = AnimationSet::create(std::move(parts)).value();
    const auto armed = armSet();
    const osg::ref_ptr<SkinnedGeometry> tube = makeTube(*armed), large = makeTube(*armed);
    for (osg::Vec3& position : positionsOf(*large))
        position *= 100.0f;
    large->setRigidEntry(static_cast<unsigned short>(set->entryOfSkin(0, 0)));
    const LodLevels levels = levelsOf(*tube, *armed->withClips({}).value()), ofLarge = levelsOf(*large, *set);
    ASSERT_TRUE(has(levels));
    EXPECT_EQ(ofLarge.finest(), levels.finest());
    EXPECT_EQ(ofLarge.coarsest(), levels.coarsest());
}

TEST(LodLevelsTest, keepTextureCoordinatesOnTheirSideOfASeam)
{
    // A flat strip of two halves; the seam has two vertices per position, with different texture coordinates.
    const auto set = testCharacterSet();
    osg::ref_ptr<SkinnedGeometry> strip = new SkinnedGeometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> texCoords = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (const unsigned int half : {0u, 1u})
        for (unsigned int column = 0; column <= 20; ++column)
            for (unsigned int row = 0; row <= 20; ++row)
            {
                positions->push_back(osg::Vec3d(20.0 * half + column, row, 0));
                texCoords->push_back(osg::Vec2d(0.5 * half + 0.01 * column, 0.01 * row));
                if (column == 20 || row == 20) continue;
                const unsigned int corner = half * 441 + column * 21 + row;
                for (const unsigned int vertex : {0u, 21u, 1u, 1u, 21u, 22u})
                    triangles->push_back(corner + vertex);
            }
    strip->setVertexArray(positions);
    strip->setTexCoordArray(0, texCoords);
    strip->setRigidEntry(static_cast<unsigned short>(set->entryOfRigidJoint(1)));
    strip->addPrimitiveSet(triangles);
    const LodLevels levels = levelsOf(*strip, *set->withClips({}).value());
    const osg::DrawElements* few = levels.reduced(0, levels.finest()).elements;
    ASSERT_NE(few, nullptr);
    EXPECT_LE(few->getNumIndices(), 3u * 40u) << "it is flat";
    for (unsigned int i = 0; i < few->getNumIndices(); i += 3)
        for (unsigned int corner = 1; corner < 3; ++corner)
            EXPECT_EQ(few->index(i) < 441, few->index(i + corner) < 441) << "triangle " << i / 3;
}

struct NothingCase
{
    const char* name;
    void (*change)(SkinnedGeometry&);
};

const NothingCase nothingCases[] = {
    {"lines", [](SkinnedGeometry& mesh) { trianglesOf(mesh).setMode(GL_LINES); }},
    {"not a number", [](SkinnedGeometry& mesh) { positionsOf(mesh)[5].x() = std::nanf(""); }},
    {"beyond all bounds", [](SkinnedGeometry& mesh) { positionsOf(mesh)[5].x() = 3e38f; }},
    {"all at one place",
     [](SkinnedGeometry& mesh)
     {
         for (osg::Vec3& position : positionsOf(mesh))
             position.set(1, 2, 3);
     }},
    {"an index out of range", [](SkinnedGeometry& mesh) { trianglesOf(mesh)[7] = 60000; }},
    {"no vertices", [](SkinnedGeometry& mesh) { mesh.setVertexArray(nullptr); }},
    {"no primitives", [](SkinnedGeometry& mesh) { mesh.removePrimitiveSet(0, 1); }},
    {"no indices", [](SkinnedGeometry& mesh) { trianglesOf(mesh).clear(); }},
    {"without indices",
     [](SkinnedGeometry& mesh) { mesh.setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 0, 3 * tubeColumns)); }},
};

TEST(LodLevelsTest, areNotMadeWhereThereIsNothingToGain)
{
    const auto set = armSet();
    for (const NothingCase& nothing : nothingCases)
    {
        const osg::ref_ptr<SkinnedGeometry> tube = makeTube(*set);
        nothing.change(*tube);
        EXPECT_FALSE(has(levelsOf(*tube, *set))) << nothing.name;
    }
}

/// A flat disc: rings of `points` vertices around a centre vertex that all triangles of the first ring share.
osg::ref_ptr<SkinnedGeometry> makeDisc(unsigned int points, unsigned int rings)
{
    osg::ref_ptr<SkinnedGeometry> disc = new SkinnedGeometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array(1);
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int ring = 0; ring < rings; ++ring)
        for (unsigned int point = 0; point < points; ++point)
        {
            const double angle = 2.0 * osg::PI * point / points, radius = 1.0 + ring;
            positions->push_back(osg::Vec3d(radius * std::cos(angle), radius * std::sin(angle), 0.0));
            const unsigned int here = 1 + ring * points + point, next = 1 + ring * points + (point + 1) % points;
            for (const unsigned int corner : {ring == 0 ? 0 : here - points, here, next})
                triangles->push_back(corner);
            if (ring == 0) continue;
            for (const unsigned int corner : {here - points, next, next - points})
                triangles->push_back(corner);
        }
    disc->setVertexArray(positions);
    disc->addPrimitiveSet(triangles);
    disc->setRigidEntry(0);
    return disc;
}

TEST(LodLevelsTest, takeNoTimeByTheSquareOfTheTrianglesAtAPoint)
{
    const auto secondsFor = [](unsigned int points)
    {
        const osg::ref_ptr<SkinnedGeometry> disc = makeDisc(points, 3);
        const std::clock_t begin = std::clock(); // CPU time: other programs may run
        EXPECT_LT(drawn(*disc, levelsOf(*disc, *armSet()), 20), disc->getPrimitiveSet(0)->getNumIndices());
        return double(std::clock() - begin) / CLOCKS_PER_SEC;
    };
    const double secondsForAnEighth = secondsFor(750);
    // Linear: 8 times; quadratic: 64 times.
    EXPECT_LT(secondsFor(6000), 20 * secondsForAnEighth);
    const osg::ref_ptr<SkinnedGeometry> tooLarge = makeDisc(LodLevels::maxVertices / 2, 2);
    EXPECT_FALSE(has(levelsOf(*tooLarge, *armSet())));
}

TEST(LodLevelsTest, areNoneAfterTheMeshHasChanged)
{
    const auto set = armSet();
    const osg::ref_ptr<SkinnedGeometry> tube = makeTube(*set);
    EXPECT_EQ(MeshDetail::findLevels(*tube), nullptr);
    const std::shared_ptr<const LodLevels> first = madeLevels(*tube, *set);
    EXPECT_EQ(MeshDetail::findLevels(*tube), first);
    tube->getVertexArray()->dirty();
    EXPECT_EQ(MeshDetail::findLevels(*tube), nullptr);
    EXPECT_NE(madeLevels(*tube, *set), first);
    tube->getPrimitiveSet(0)->dirty();
    EXPECT_EQ(MeshDetail::findLevels(*tube), nullptr);
}

template <typename Animated>
void expectTakesPixelErrors(Animated& animated)
{
    const float infinity = std::numeric_limits<float>::infinity();
    const std::pair<float, bool> cases[] = {{0.0f, true},    {0.5f, true},      {1e6f, true},          {-0.5f, false},
                                            {1.1e6f, false}, {infinity, false}, {std::nanf(""), false}};
    for (const auto& [pixels, isTaken] : cases)
    {
        ASSERT_TRUE(animated.getMeshes().setPixelError(2.0f));
        const Result<void> taken = animated.getMeshes().setPixelError(pixels);
        EXPECT_EQ(static_cast<bool>(taken), isTaken) << pixels;
        EXPECT_EQ(animated.getMeshes().getPixelError(), isTaken ? pixels : 2.0f);
        if (taken) continue;
        EXPECT_NE(taken.error().message.find("it must be a number of pixels from 0 to 1000000"), std::string::npos);
    }
}

TEST(PixelErrorTest, charactersAndCrowdsTakeTheSame)
{
    expectTakesPixelErrors(*makeTestCharacter());
    expectTakesPixelErrors(*osg::ref_ptr<AnimatedCharacter>(new AnimatedCharacter));
    expectTakesPixelErrors(*makeCrowd(*makeTestCharacter()));
}

} // namespace

} // namespace osgGpuAnimation
