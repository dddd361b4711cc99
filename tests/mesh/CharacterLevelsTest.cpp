// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/MadeLevels.h"
#include "support/ShownSurface.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/lod/MergedParts.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/Material>

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <random>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int armParts = 16;
constexpr int coarsestOfAll = 99;

/// A character of a tube in parts.
struct Arm
{
    std::shared_ptr<const AnimationSet> set = armSet(true);
    osg::ref_ptr<osg::Group> meshes = new osg::Group;
    std::vector<osg::ref_ptr<SkinnedGeometry>> parts = makeTubeParts(*set, armParts);

    Arm()
    {
        parts.front()->getStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON); // nothing is seen inside
        for (const osg::ref_ptr<SkinnedGeometry>& part : parts)
            meshes->addChild(part);
    }

    std::vector<AffineMatrix> paletteAt(const PoseInstruction& pose) const
    {
        std::vector<AffineMatrix> palette;
        Pose::evaluate(*set, pose, AffineMatrix(), palette);
        return palette;
    }
    bool has(const SkinnedGeometry& mesh) const { return meshes->containsNode(&mesh); }

    /// The meshes of a level that are none of the parts.
    std::vector<const SkinnedGeometry*> mergedAt(const CharacterLevels& levels, int level) const
    {
        std::vector<const SkinnedGeometry*> merged;
        levels.forEachMeshAt(level, *meshes,
                             [&](const SkinnedGeometry& mesh)
                             {
                                 if (!has(mesh)) merged.push_back(&mesh);
                             });
        return merged;
    }
    std::size_t timesDrawn(const CharacterLevels& levels, int level, const SkinnedGeometry& part) const
    {
        std::size_t times = 0;
        levels.forEachMeshAt(level, *meshes, [&](const SkinnedGeometry& mesh) { times += &mesh == &part; });
        return times;
    }
};

osg::ref_ptr<osg::StateSet> stateOf(const osg::Vec4& color)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    state->setAttribute(material);
    state->setMode(GL_CULL_FACE, osg::StateAttribute::ON); // the tubes are open: nothing is seen inside
    applyCharacterProgram(*state);
    return state;
}

struct MaterialsCase
{
    const char* name;
    std::size_t mergedMeshes;
    void (*change)(Arm&);
};

const MaterialsCase materialsCases[] = {
    {"one StateSet", 1, [](Arm&) {}},
    {"equal StateSets", 1,
     [](Arm& arm)
     {
         for (const osg::ref_ptr<SkinnedGeometry>& part : arm.parts)
         {
             part->setStateSet(stateOf({1, 0, 0, 1}));
             applySkinDefines(*part->getStateSet(), 2 + (part == arm.parts[0]), false);
         }
     }},
    {"two colours", 2,
     [](Arm& arm)
     {
         for (std::size_t part = 0; part < armParts; ++part)
             arm.parts[part]->setStateSet(stateOf({1, part < armParts / 2 ? 1.0f : 0.0f, 0, 1}));
     }},
    {"two masks", 2,
     [](Arm& arm)
     {
         for (std::size_t part = 0; part < armParts / 2; ++part)
             arm.parts[part]->setNodeMask(2);
     }},
};

TEST(CharacterLevelsTest, aCrowdKeepsThemWithoutAPixelError)
{
    const Arm arm;
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(arm.set, arm.parts);
    ASSERT_TRUE(crowd->getMeshes().setPixelError(1.0f));
    crowd->getMeshes().waitForLevels();
    const std::shared_ptr<const CharacterLevels> first = CrowdDetail::levels(*crowd);
    ASSERT_TRUE(first);
    ASSERT_TRUE(crowd->getMeshes().setPixelError(0.0f));
    crowd->update(0.0);
    ASSERT_TRUE(crowd->getMeshes().setPixelError(1.0f));
    EXPECT_EQ(CrowdDetail::levels(*crowd), first);
    arm.parts[0]->setNodeMask(0);
    ASSERT_TRUE(crowd->getMeshes().setPixelError(1.0f));
    EXPECT_NE(CrowdDetail::levels(*crowd), first) << "other meshes";
}

TEST(CharacterLevelsTest, partsOfOneMaterialBecomeOneMesh)
{
    for (const MaterialsCase& materials : materialsCases)
    {
        SCOPED_TRACE(materials.name);
        Arm arm;
        materials.change(arm);
        const std::shared_ptr<const CharacterLevels> levelsMade = madeLevels(*arm.meshes, *arm.set);
        const CharacterLevels& levels = *levelsMade;
        EXPECT_EQ(arm.mergedAt(levels, coarsestOfAll).size(), materials.mergedMeshes);
        EXPECT_EQ(arm.mergedAt(levels, levels.finest() - 1).size(), 0u);
        EXPECT_EQ(arm.mergedAt(levels, LodLevels::allTriangles).size(), 0u);
        for (const osg::ref_ptr<SkinnedGeometry>& part : arm.parts)
        {
            EXPECT_TRUE(levels.isMerged(*part, coarsestOfAll));
            EXPECT_EQ(arm.timesDrawn(levels, coarsestOfAll, *part), 0u);
            EXPECT_FALSE(levels.isMerged(*part, LodLevels::allTriangles));
            EXPECT_EQ(arm.timesDrawn(levels, LodLevels::allTriangles, *part), 1u);
        }
        EXPECT_EQ(levels.foundError(LodLevels::allTriangles), 0.0);
        for (const SkinnedGeometry* mesh : arm.mergedAt(levels, coarsestOfAll))
        {
            EXPECT_NE(mesh->getNodeMask(), 0u);
            ASSERT_TRUE(mesh->getStateSet() && mesh->getColorArray());
            EXPECT_EQ(mesh->getColorArray()->getNumElements(), mesh->getVertexCount());
        }
    }
}

struct OddPart : osg::Drawable::DrawCallback
{
};

struct UnmergedCase
{
    const char* name;
    void (*change)(SkinnedGeometry&, const AnimationSet&);
};

const UnmergedCase unmergedCases[] = {
    {"morph targets",
     [](SkinnedGeometry& part, const AnimationSet& set)
     {
         const auto count = static_cast<unsigned int>(part.getVertexCount());
         part.setMorphTargets(set, 0,
                              {{new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, count), nullptr, nullptr, nullptr}});
     }},
    {"hidden", [](SkinnedGeometry& part, const AnimationSet&) { part.setNodeMask(0); }},
    {"a draw callback", [](SkinnedGeometry& part, const AnimationSet&) { part.setDrawCallback(new OddPart); }},
    {"a cull callback",
     [](SkinnedGeometry& part, const AnimationSet&) { part.setCullCallback(new osg::NodeCallback); }},
    {"a program of its own",
     [](SkinnedGeometry& part, const AnimationSet&)
     {
         part.setStateSet(new osg::StateSet(*part.getStateSet()));
         part.getStateSet()->setAttribute(new osg::Program);
     }},
    {"lines", [](SkinnedGeometry& part, const AnimationSet&) { part.getPrimitiveSet(0)->setMode(GL_LINES); }},
    {"triangles without indices", [](SkinnedGeometry& part, const AnimationSet&)
     { part.setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 0, 3 * tubeRows)); }},
};

TEST(CharacterLevelsTest, otherPartsKeepTheirOwnLevels)
{
    for (const UnmergedCase& odd : unmergedCases)
    {
        SCOPED_TRACE(odd.name);
        Arm arm;
        odd.change(*arm.parts[1], *arm.set);
        const std::shared_ptr<const CharacterLevels> levelsMade = madeLevels(*arm.meshes, *arm.set);
        const CharacterLevels& levels = *levelsMade;
        EXPECT_EQ(arm.mergedAt(levels, coarsestOfAll).size(), 1u);
        for (std::size_t part = 0; part < armParts; ++part)
        {
            EXPECT_EQ(levels.isMerged(*arm.parts[part], coarsestOfAll), part != 1) << part;
            EXPECT_EQ(arm.timesDrawn(levels, coarsestOfAll, *arm.parts[part]), part == 1 ? 1u : 0u) << part;
        }
    }
}

TEST(CharacterLevelsTest, haveFewerTrianglesLevelByLevelAndTheFoundErrorOfAllVertices)
{
    const Arm arm;
    const std::shared_ptr<const CharacterLevels> levelsMade = madeLevels(*arm.meshes, *arm.set);
    const CharacterLevels& levels = *levelsMade;
    ASSERT_NE(levels.finest(), LodLevels::allTriangles);
    std::vector<PoseInstruction> poses = keyPoses(*arm.set, LodLevels::minPoses);
    const std::size_t keyPoseCount = poses.size();
    std::mt19937 random(5);
    for (int i = 0; i < 50; ++i)
        poses.emplace_back().samples[0] = arm.set->sampleAt(0, 0.001 * static_cast<int>(random() % 1000));
    const auto surfaceAt = [&](int level, const std::vector<AffineMatrix>& palette)
    { return ShownSurface(*arm.meshes, *arm.set, &levels, level, palette); };
    const auto trianglesAt = [&](int level) { return surfaceAt(level, arm.paletteAt(poses[0])).triangleCount(); };
    EXPECT_LE(trianglesAt(levels.finest()), tubeTriangles / 8);
    EXPECT_LE(trianglesAt(levels.coarsest()), tubeTriangles / 40) << "coarser ones do not look like the tube";
    EXPECT_GE(trianglesAt(levels.coarsest()), 2u);
    EXPECT_EQ(trianglesAt(coarsestOfAll), trianglesAt(levels.coarsest()));
    double before = 0.0;
    for (int level = levels.finest(); level <= levels.coarsest(); ++level)
    {
        EXPECT_LE(trianglesAt(level), trianglesAt(level - 1)) << level;
        EXPECT_LE(levels.foundError(level), (1.0 + 1e-6) * LodLevels::errorOf(level)) << level << ": sums of floats";
        EXPECT_GE(levels.foundError(level), before) << level;
        before = levels.foundError(level);
        for (std::size_t pose = 0; pose < poses.size(); ++pose)
        {
            const std::vector<AffineMatrix> palette = arm.paletteAt(poses[pose]);
            // The error is measured in the key poses; others may have a slightly larger one.
            EXPECT_LE(surfaceAt(level, palette).largestDistance(palette),
                      (pose < keyPoseCount ? 1.0001 : 1.5) * levels.foundError(level))
                << "level " << level << ", pose " << pose;
        }
    }
}

struct ChangeCase
{
    const char* name;
    void (*change)(Arm&);
};

const ChangeCase changeCases[] = {
    {"vertices", [](Arm& arm) { arm.parts[1]->getVertexArray()->dirty(); }},
    {"another vertex array",
     [](Arm& arm)
     {
         const osg::Array& vertices = *arm.parts[1]->getVertexArray();
         arm.parts[1]->setVertexArray(osg::clone(&vertices, osg::CopyOp::DEEP_COPY_ALL));
     }},
    {"triangles", [](Arm& arm) { arm.parts[1]->getPrimitiveSet(0)->dirty(); }},
    {"other triangles",
     [](Arm& arm) { arm.parts[1]->setPrimitiveSet(0, osg::clone(arm.parts[1]->getPrimitiveSet(0))); }},
    {"hidden", [](Arm& arm) { arm.parts[3]->setNodeMask(0); }},
    {"another mask", [](Arm& arm) { arm.parts[3]->setNodeMask(2); }},
    {"another StateSet",
     [](Arm& arm) {
         arm.parts[2]->setStateSet(stateOf({0, 1, 0, 1}));
     }},
    {"a part fewer", [](Arm& arm) { arm.meshes->removeChild(2, 1); }},
    {"a part more", [](Arm& arm) { arm.meshes->addChild(makeTube(*arm.set)); }},
    {"another set", [](Arm& arm) { arm.set = arm.set->withClips({}).value(); }},
};

TEST(CharacterLevelsTest, noticeWhenTheMeshesAreNoLongerTheSame)
{
    for (const ChangeCase& each : changeCases)
    {
        Arm arm;
        const auto first = arm.set; // another one must not take its address
        for (const osg::ref_ptr<SkinnedGeometry>& part : arm.parts)
            part->setStateSet(new osg::StateSet); // nothing to merge, which would take time
        const std::shared_ptr<const CharacterLevels> levelsMade = madeLevels(*arm.meshes, *arm.set);
        const CharacterLevels& levels = *levelsMade;
        ASSERT_TRUE(levels.isOf(*arm.meshes, *arm.set));
        arm.meshes->addChild(new osg::Group);
        EXPECT_TRUE(levels.isOf(*arm.meshes, *arm.set)) << "a child without a mesh";
        each.change(arm);
        EXPECT_FALSE(levels.isOf(*arm.meshes, *arm.set)) << each.name;
    }
}

/// A strip of triangles between vertices at those places.
template <typename Place>
osg::ref_ptr<SkinnedGeometry> makeStrip(std::size_t vertices, Place placeOf)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
    {
        positions->push_back(placeOf(static_cast<float>(vertex)));
        if (vertex < 2) continue;
        for (const std::size_t back : {2, 1, 0})
            triangles->push_back(static_cast<GLushort>(vertex - back));
    }
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->setVertexArray(positions);
    mesh->addPrimitiveSet(triangles);
    mesh->setRigidEntry(0);
    applyCharacterProgram(*mesh->getOrCreateStateSet());
    return mesh;
}

struct LimitCase
{
    const char* name;
    bool hasLevels;
    void (*fill)(osg::Group&, const AnimationSet&);
};

/// Bands of 280 vertices above each other.
template <std::size_t vertices>
void addBands(osg::Group& meshes, const AnimationSet&)
{
    meshes.addChild(makeStrip(vertices,
                              [](float i)
                              {
                                  const float band = std::floor(i / 280.0f), inBand = i - 280.0f * band;
                                  return osg::Vec3(std::floor(0.5f * inBand), 2.0f * band + std::fmod(i, 2.0f), 0);
                              }));
}

template <std::size_t parts>
void addTubes(osg::Group& meshes, const AnimationSet& set)
{
    std::vector<osg::ref_ptr<SkinnedGeometry>> ofTube;
    for (std::size_t part = 0; part < parts; ++part)
    {
        if (part % tubeColumns == 0) ofTube = makeTubeParts(set, tubeColumns);
        SkinnedGeometry& mesh = *ofTube[part % tubeColumns];
        for (osg::Vec3& position : static_cast<osg::Vec3Array&>(*mesh.getVertexArray()))
            position.y() += 2.0f * static_cast<float>(part / tubeColumns);
        if (part > 0) mesh.setStateSet(meshes.getChild(0)->getStateSet());
        meshes.addChild(&mesh);
    }
}

const LimitCase limitCases[] = {
    {"no meshes", false, [](osg::Group&, const AnimationSet&) {}},
    {"the most parts", true, addTubes<CharacterLevels::maxParts>},
    {"more parts", false, addTubes<CharacterLevels::maxParts + 1>},
    {"the most vertices", true, addBands<MergedParts::maxVertices>},
    {"more vertices", false, addBands<MergedParts::maxVertices + 1>},
    {"a position that is not finite", false,
     [](osg::Group& meshes, const AnimationSet&)
     {
         meshes.addChild(makeStrip(
             100, [](float i) { return osg::Vec3(i < 50.0f ? i : std::numeric_limits<float>::infinity(), i, 0); }));
     }},
    {"a position whose square is not finite", false,
     [](osg::Group& meshes, const AnimationSet&)
     { meshes.addChild(makeStrip(100, [](float i) { return osg::Vec3(i, 1e30f * i, 0); })); }},
    {"all in one point", false,
     [](osg::Group& meshes, const AnimationSet&)
     { meshes.addChild(makeStrip(100, [](float) { return osg::Vec3(1, 2, 3); })); }},
    {"thousands in one place", true,
     [](osg::Group& meshes, const AnimationSet&)
     {
         meshes.addChild(makeStrip(MergedParts::maxVertices,
                                   [](float i)
                                   {
                                       if (i < 10.0f) return osg::Vec3(i, std::fmod(i, 2.0f), 0);
                                       return osg::Vec3(10, 0, 0) +
                                              osg::Vec3(std::sin(i), std::sin(1.7f * i), std::sin(2.9f * i)) * 1e-3f;
                                   }));
     }},
};

TEST(CharacterLevelsTest, oddMeshesTakeBoundedTime)
{
    const auto set = armSet();
    for (const LimitCase& limit : limitCases)
    {
        SCOPED_TRACE(limit.name);
        const osg::ref_ptr<osg::Group> meshes = new osg::Group;
        limit.fill(*meshes, *set);
        const std::clock_t begin = std::clock(); // CPU time: other programs may run
        const std::shared_ptr<const CharacterLevels> levelsMade = madeLevels(*meshes, *set);
        const CharacterLevels& levels = *levelsMade;
        const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
        EXPECT_LT(seconds, 30.0) << "by the square of the vertices it would take minutes";
        EXPECT_EQ(levels.finest() != LodLevels::allTriangles, limit.hasLevels);
        EXPECT_EQ(levels.coarsest() != LodLevels::allTriangles, limit.hasLevels);
    }
}

} // namespace

} // namespace osgGpuAnimation
