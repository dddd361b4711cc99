// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdCells.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace osgGpuAnimation
{

namespace
{

bool reaches(const glm::vec4& sphere, const std::vector<glm::vec4>& planes)
{
    bool reaches = sphere.w >= 0.0f;
    for (const glm::vec4& plane : planes)
        reaches = reaches && plane.x * sphere.x + plane.y * sphere.y + plane.z * sphere.z + plane.w >= -sphere.w;
    return reaches;
}

struct CrowdCase
{
    const char* name;
    float extent; ///< of the places
    float centre; ///< of the places, on each axis
    float radius;
};

void PrintTo(const CrowdCase& crowd, std::ostream* out)
{
    *out << crowd.name;
}

class CrowdCellsTest : public testing::TestWithParam<CrowdCase>
{
protected:
    float number(float least, float most) { return std::uniform_real_distribution<float>(least, most)(_random); }

    glm::vec4 sphere()
    {
        const CrowdCase& crowd = GetParam();
        glm::vec4 made;
        for (int axis = 0; axis < 3; ++axis)
            made[axis] = crowd.centre + number(-crowd.extent, crowd.extent);
        const float size = number(-0.05f, 1.0f); // some are empty
        made.w = size < 0.0f ? -1.0f : size * crowd.radius;
        return made;
    }

    std::vector<glm::vec4> planes()
    {
        std::vector<glm::vec4> made;
        for (int i = 0; i < 3; ++i)
        {
            glm::vec3 normal;
            for (int axis = 0; axis < 3; ++axis)
                normal[axis] = number(-1.0f, 1.0f);
            normal = glm::normalize(normal);
            const glm::vec3 place = glm::vec3(GetParam().centre) + number(-0.7f, 0.3f) * GetParam().extent * normal;
            made.emplace_back(normal, -glm::dot(normal, place));
        }
        made[2] *= 0.01f; // small feature culling has no unit normal
        return made;
    }

    std::size_t below(std::size_t end) { return static_cast<std::size_t>(_random() % end); }

    std::mt19937 _random{7};
};

} // namespace

// Against a test of each sphere, while instances come, go and move.
TEST_P(CrowdCellsTest, findWhatATestOfEachSphereFinds)
{
    CrowdCells cells;
    std::vector<glm::vec4> spheres;
    SeenMembers members;
    std::vector<std::uint32_t> found;
    const auto find = [&](const CrowdCells& in, const std::vector<glm::vec4>& sides)
    {
        in.findSeen(sides, members);
        members.findIndices(spheres.size(), found);
        for (const SeenMembers::Span& span : members.spans())
            for (const CrowdMember* member = span.begin; member != span.end; ++member)
            {
                EXPECT_EQ(member->sphere, spheres[member->index]);
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LE(std::abs(member->sphere[axis] - span.centre[axis]),
                              span.half[axis] + 1e-6f * std::abs(span.centre[axis]));
                EXPECT_LE(member->sphere.w, span.radius);
            }
    };
    std::size_t seen = 0;
    for (int round = 0; round < 40; ++round)
    {
        for (int i = 0; i < 100; ++i)
        {
            spheres.push_back(sphere());
            cells.add(spheres.back());
        }
        for (int i = 0; i < 30; ++i)
        {
            const std::size_t index = below(spheres.size());
            cells.remove(index);
            spheres[index] = spheres.back();
            spheres.pop_back();
        }
        for (int i = 0; i < 200; ++i)
        {
            const std::size_t index = below(spheres.size());
            if (i % 2 == 0)
                spheres[index] = sphere();
            else // mostly within its cell
                spheres[index] += glm::vec4(number(-2.0f, 2.0f), number(-2.0f, 2.0f), 0.0f, 0.0f) * GetParam().radius;
            cells.set(index, spheres[index]);
        }
        const CrowdCells copy(cells);
        for (const std::vector<glm::vec4>& sides : {planes(), std::vector<glm::vec4>()})
        {
            std::vector<std::uint32_t> expected;
            for (std::size_t index = 0; index < spheres.size(); ++index)
                if (reaches(spheres[index], sides)) expected.push_back(static_cast<std::uint32_t>(index));
            find(cells, sides);
            EXPECT_EQ(found, expected) << round;
            find(copy, sides);
            EXPECT_EQ(found, expected) << round << ", copy";
            seen += sides.empty() ? 0 : expected.size();
        }
    }
    EXPECT_GT(seen, 100u);
    EXPECT_LE(cells.cellCount(), 64 + spheres.size() / 4) << "a cell holds several instances on average";
    EXPECT_GE(cells.cellCount(), GetParam().extent > 0.0f ? spheres.size() / 1024 : 1u);
    while (!spheres.empty())
    {
        cells.remove(spheres.size() - 1);
        spheres.pop_back();
    }
    find(cells, {});
    EXPECT_TRUE(found.empty());
    EXPECT_EQ(cells.cellCount(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Crowds, CrowdCellsTest,
                         testing::Values(CrowdCase{"field", 100.0f, 0.0f, 1.0f}, CrowdCase{"dense", 1.0f, 50.0f, 0.01f},
                                         CrowdCase{"sparse", 1e6f, 0.0f, 1.0f},
                                         CrowdCase{"farFromTheOrigin", 100.0f, 1e7f, 2.0f},
                                         CrowdCase{"endless", 1e30f, 0.0f, 1.0f},
                                         CrowdCase{"points", 0.0f, 3.0f, 0.0f}),
                         [](const auto& info) { return info.param.name; });

TEST(CullScopesTest, theVisitorHasItsNearFarModeAndInheritanceBack)
{
    using Settings = osg::CullSettings;
    const std::pair<Settings::ComputeNearFarMode, Settings::ComputeNearFarMode> modes[] = {
        {Settings::COMPUTE_NEAR_FAR_USING_PRIMITIVES, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
        {Settings::COMPUTE_NEAR_USING_PRIMITIVES, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
        {Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
        {Settings::DO_NOT_COMPUTE_NEAR_FAR, Settings::DO_NOT_COMPUTE_NEAR_FAR}};
    for (const auto& [outside, inside] : modes)
    {
        const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
        visitor->setComputeNearFarMode(outside);
        visitor->setInheritanceMask(Settings::ALL_VARIABLES);
        for (int mesh = 0; mesh < 2; ++mesh)
        {
            const BoxNearFar boxes(*visitor);
            EXPECT_EQ(visitor->getComputeNearFarMode(), inside);
        }
        EXPECT_EQ(visitor->getComputeNearFarMode(), outside);
        // Without its bit the visitor would ignore the mode of a camera below it.
        EXPECT_EQ(visitor->getInheritanceMask(), static_cast<unsigned int>(Settings::ALL_VARIABLES));
    }
}

} // namespace osgGpuAnimation
