// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <random>

// The CPU twin's normals, measured by its positions: a triangle's normal stays at a right angle to the posed triangle,
// on the side of the apex of a tetrahedron over it.

namespace osgGpuAnimation
{

namespace
{

using Corners = std::array<glm::dvec3, 4>; ///< a triangle, and the apex: its first corner plus its normal

osg::Vec3 toOsg(const glm::dvec3& v)
{
    return osg::Vec3(v.x, v.y, v.z);
}

class Tetrahedra
{
public:
    explicit Tetrahedra(unsigned int seed) : _random(seed) {}

    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(_random); }

    Corners corners()
    {
        Corners corners;
        for (int corner = 0; corner < 3; ++corner)
            corners[corner] = {number(-1, 1), number(-1, 1), number(-1, 1)};
        corners[3] = corners[0] + normalOf(corners);
        return corners;
    }

    /// Any affine matrix: with shear, mirrored or not.
    AffineMatrix matrix()
    {
        AffineMatrix matrix;
        for (glm::vec4& row : matrix.rows)
            for (int column = 0; column < 4; ++column)
                row[column] = static_cast<float>(number(-1, 1));
        return matrix;
    }

    static glm::dvec3 normalOf(const Corners& c) { return glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0])); }

private:
    std::mt19937 _random;
};

/// Two influences whose weights sum to 1.25, and a morph target that leads to `morphed` at weight 1.
osg::ref_ptr<SkinnedGeometry> makeMesh(const Corners& bind, const Corners& morphed)
{
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    MorphTarget target{new osg::Vec3Array, new osg::Vec3Array, nullptr, nullptr};
    for (std::size_t corner = 0; corner < bind.size(); ++corner)
    {
        positions->push_back(toOsg(bind[corner]));
        normals->push_back(toOsg(Tetrahedra::normalOf(bind)));
        target.positions->push_back(toOsg(morphed[corner] - bind[corner]));
        target.normals->push_back(toOsg(Tetrahedra::normalOf(morphed) - Tetrahedra::normalOf(bind)));
    }
    mesh->setVertexArray(positions);
    mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    mesh->setInfluences(0, new osg::Vec4usArray(4), new osg::Vec4Array(4));
    for (std::size_t corner = 0; corner < bind.size(); ++corner)
    {
        const_cast<osg::Vec4usArray&>(*mesh->getEntries(0))[corner].set(1, 2, 0, 0);
        const_cast<osg::Vec4Array&>(*mesh->getWeights(0))[corner].set(0.5f, 0.75f, 0, 0);
    }
    mesh->setMorphTargets(0, 0, {target});
    return mesh;
}

TEST(SkinnedNormalsTest, stayAtARightAngleToTheMorphedAndSkinnedTriangle)
{
    Tetrahedra random(7);
    int mirrored = 0;
    for (int round = 0; round < 400; ++round)
    {
        const osg::ref_ptr<SkinnedGeometry> mesh = makeMesh(random.corners(), random.corners());
        std::vector<AffineMatrix> palette{AffineMatrix(), random.matrix(), random.matrix()};
        palette[0].rows[0].x = static_cast<float>(round % 2); // the morph's weight
        std::vector<glm::dvec3> positions, normals;
        mesh->computePositions(palette, positions);
        mesh->computeNormals(palette, normals);
        ASSERT_EQ(positions.size(), 4u);
        ASSERT_EQ(normals.size(), 4u);
        const Corners posed{positions[0], positions[1], positions[2], positions[3]};
        const double side = glm::dot(Tetrahedra::normalOf(posed), posed[3] - posed[0]);
        mirrored += side < 0.0;
        const glm::dvec3 expected = Tetrahedra::normalOf(posed) * (side < 0.0 ? -1.0 : 1.0);
        for (const glm::dvec3& normal : normals)
            EXPECT_LE(glm::length(glm::normalize(normal) - expected), 2e-4) << "round " << round;
    }
    EXPECT_GT(mirrored, 100);
    EXPECT_LT(mirrored, 300);
}

// Palette entries hold twelve weights; target 13 is the second one of the second entry. Its array has one vertex.
TEST(SkinnedNormalsTest, eachMorphTargetHasItsOwnWeight)
{
    const osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->setVertexArray(new osg::Vec3Array(2));
    mesh->setRigidEntry(0);
    std::vector<MorphTarget> targets;
    for (unsigned int target = 0; target < 14; ++target)
    {
        targets.push_back({new osg::Vec3Array(target == 13 ? 1 : 2), nullptr, nullptr, nullptr});
        (*targets.back().positions)[0].z() = target == 13 ? 1.0f : 100.0f;
    }
    mesh->setMorphTargets(0, 1, targets);
    std::vector<AffineMatrix> palette(3);
    for (std::size_t entry = 1; entry < 3; ++entry)
        palette[entry].rows = {};
    palette[2].rows[0].y = 0.75f;
    std::vector<glm::dvec3> positions;
    mesh->computePositions(palette, positions);
    ASSERT_EQ(positions.size(), 2u);
    EXPECT_EQ(positions[0], glm::dvec3(0.0, 0.0, 0.75));
    EXPECT_EQ(positions[1], glm::dvec3(0.0));
}

TEST(SkinnedNormalsTest, thereAreNoneWithoutOneAVertex)
{
    Tetrahedra random(8);
    const osg::ref_ptr<SkinnedGeometry> mesh = makeMesh(random.corners(), random.corners());
    const std::vector<AffineMatrix> palette(3);
    std::vector<glm::dvec3> normals(7);
    mesh->setNormalArray(new osg::Vec3Array(1), osg::Array::BIND_OVERALL);
    mesh->computeNormals(palette, normals);
    EXPECT_TRUE(normals.empty());
    normals.resize(7);
    mesh->setNormalArray(nullptr);
    mesh->computeNormals(palette, normals);
    EXPECT_TRUE(normals.empty());
}

} // namespace

} // namespace osgGpuAnimation
