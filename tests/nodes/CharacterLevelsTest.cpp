// SPDX-License-Identifier: MIT
#include "nodes/Tube.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>
#include <osgGpuAnimation/nodes/lod/MeshConnectivity.h>
#include <osgGpuAnimation/nodes/lod/Silhouettes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr int coarseLevel = 0; // 1; the tubes are 8 long

/// Two tubes side by side with one StateSet.
class TwoTubes
{
public:
    TwoTubes()
    {
        for (osg::Vec3& position : positions())
            position.y() += 0.9f;
        second->setStateSet(first->getStateSet());
        group->addChild(first);
        group->addChild(second);
    }

    osg::Vec3Array& positions() { return static_cast<osg::Vec3Array&>(*second->getVertexArray()); }
    std::vector<const SkinnedGeometry*> drawnAt(int level) const
    {
        std::vector<const SkinnedGeometry*> drawn;
        LodRange::ofCharacter(1.0f, *group, *set)
            .forEachMeshAt(level, *group, [&](const SkinnedGeometry& mesh) { drawn.push_back(&mesh); });
        return drawn;
    }

    std::shared_ptr<const AnimationSet> set = armSet();
    osg::ref_ptr<SkinnedGeometry> first = makeShownTube(*set), second = makeShownTube(*set);
    osg::ref_ptr<osg::Group> group = new osg::Group;
};

struct AlikeCase
{
    const char* name;
    void (*change)(TwoTubes& tubes);
    std::size_t drawn; ///< meshes at the coarse level
};

void PrintTo(const AlikeCase& alike, std::ostream* out)
{
    *out << alike.name;
}

void noChange(TwoTubes&) {}

const AlikeCase alikeCases[] = {
    {"nothing", noChange, 1},
    {"one of two influences",
     [](TwoTubes& tubes)
     {
         tubes.second->setStateSet(new osg::StateSet(*tubes.first->getStateSet(), osg::CopyOp::SHALLOW_COPY));
         applySkinDefines(*tubes.second->getStateSet(), 1, true);
         applySkinDefines(*tubes.first->getStateSet(), 2, true);
     },
     1},
    {"another StateSet",
     [](TwoTubes& tubes)
     {
         tubes.second->setStateSet(new osg::StateSet(*tubes.first->getStateSet(), osg::CopyOp::SHALLOW_COPY));
         tubes.second->getStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
     },
     2},
    {"hidden: its node mask lets nobody draw it", [](TwoTubes& tubes) { tubes.second->setNodeMask(0); }, 2},
    {"another node mask", [](TwoTubes& tubes) { tubes.second->setNodeMask(2); }, 2},
    {"colours",
     [](TwoTubes& tubes)
     {
         const auto count = static_cast<unsigned int>(tubes.second->getVertexCount());
         tubes.second->setColorArray(new osg::Vec4Array(count), osg::Array::BIND_PER_VERTEX);
     },
     2},
    {"a draw callback", [](TwoTubes& tubes) { tubes.second->setDrawCallback(new osg::Drawable::DrawCallback); }, 2},
};

class AlikePartsTest : public ::testing::TestWithParam<AlikeCase>
{
};

TEST_P(AlikePartsTest, becomeOneMeshAtCoarseLevels)
{
    TwoTubes tubes;
    const std::vector<const SkinnedGeometry*> before = tubes.drawnAt(coarseLevel);
    EXPECT_EQ(before.size(), 1u);
    GetParam().change(tubes);
    EXPECT_EQ(tubes.drawnAt(LodLevels::allTriangles), (std::vector<const SkinnedGeometry*>{tubes.first, tubes.second}));
    const std::vector<const SkinnedGeometry*> drawn = tubes.drawnAt(coarseLevel);
    EXPECT_EQ(drawn.size(), GetParam().drawn);
    EXPECT_EQ(tubes.drawnAt(coarseLevel), drawn) << "made again";
    EXPECT_EQ(drawn == before, GetParam().change == noChange);
}

INSTANTIATE_TEST_SUITE_P(After, AlikePartsTest, ::testing::ValuesIn(alikeCases));

std::vector<std::uint32_t> indicesOf(const SkinnedGeometry& mesh, std::uint32_t first)
{
    std::vector<std::uint32_t> indices = trianglesOf(*mesh.getPrimitiveSet(0), mesh.getVertexCount());
    for (std::uint32_t& index : indices)
        index += first;
    return indices;
}

TEST(CharacterLevelsTest, keepTheErrorAndTheSilhouettesOfTheKeyPoses)
{
    const TwoTubes tubes;
    Silhouettes::Poses all;
    std::vector<std::vector<AffineMatrix>> palettes;
    std::vector<std::uint32_t> indices = indicesOf(*tubes.first, 0);
    for (const std::uint32_t index :
         indicesOf(*tubes.second, static_cast<std::uint32_t>(tubes.first->getVertexCount())))
        indices.push_back(index);
    for (const PoseInstruction& pose : keyPoses(*tubes.set, LodLevels::poseCount))
    {
        Pose::evaluate(*tubes.set, pose, AffineMatrix(), palettes.emplace_back());
        all.emplace_back();
        std::vector<glm::dvec3> positions;
        for (const osg::ref_ptr<SkinnedGeometry>& tube : {tubes.first, tubes.second})
        {
            tube->computePositions(palettes.back(), positions);
            all.back().insert(all.back().end(), positions.begin(), positions.end());
        }
    }
    const Silhouettes silhouettes(all);
    const double area = silhouettes.meanArea(all, indices);
    std::size_t fewest = indices.size();
    for (const int level : {-1, 0})
    {
        const std::vector<const SkinnedGeometry*> drawn = tubes.drawnAt(level);
        ASSERT_EQ(drawn.size(), 1u) << level;
        const std::vector<std::uint32_t> coarse = indicesOf(*drawn.front(), 0);
        EXPECT_LE(coarse.size(), fewest);
        fewest = coarse.size();
        Silhouettes::Poses poses;
        double largest = 0.0;
        for (std::size_t pose = 0; pose < palettes.size(); ++pose)
        {
            std::vector<glm::dvec3> posed;
            drawn.front()->computePositions(palettes[pose], posed);
            poses.emplace_back(posed.begin(), posed.end());
            for (const glm::vec3& vertex : all[pose])
            {
                double nearest = 1e30;
                for (std::size_t i = 0; i < coarse.size(); i += 3)
                    nearest = std::min(nearest, squaredDistanceToTriangle(glm::dvec3(vertex), posed[coarse[i]],
                                                                          posed[coarse[i + 1]], posed[coarse[i + 2]]));
                largest = std::max(largest, nearest);
            }
        }
        EXPECT_LE(std::sqrt(largest), std::ldexp(1.0, level)) << level;
        // The search looks at four of the poses.
        EXPECT_NEAR(silhouettes.meanArea(poses, coarse) / area, 1.0, 0.04) << level;
    }
    EXPECT_LE(fewest, 3u * 40u);
}

} // namespace

} // namespace osgGpuAnimation
