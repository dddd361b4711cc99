// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/authoring/mesh/SurfaceViews.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/lod/SurfaceColor.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Fog>
#include <osg/FrontFace>
#include <osg/ImageStream>
#include <osg/TexMat>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string>

namespace osgGpuAnimation
{

namespace
{

using Seen = SurfaceViews::Seen;

constexpr std::size_t cellsOfView = SurfaceViews::cellsAcross * SurfaceViews::cellsAcross;

struct Triangles
{
    SurfaceViews::Poses poses{1};
    std::vector<std::uint32_t> indices;

    SurfaceViews::Surface surface(bool isTwoSided = false) const { return {poses, indices, isTwoSided}; }
    /// Faces the side from which it is counter-clockwise.
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
    {
        for (const glm::vec3& corner : {a, b, c})
        {
            indices.push_back(static_cast<std::uint32_t>(poses[0].size()));
            poses[0].push_back(corner);
        }
    }
    /// A square that faces +Z.
    void addSquare(const glm::vec3& lowerLeft, float side)
    {
        const glm::vec3 right(side, 0, 0), up(0, side, 0);
        add(lowerLeft, lowerLeft + right, lowerLeft + right + up);
        add(lowerLeft, lowerLeft + right + up, lowerLeft + up);
    }
};

/// A cube around the origin whose faces face outwards, two triangles each: -X, +X, -Y and so on.
Triangles makeCube(float side)
{
    Triangles cube;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
        {
            glm::vec3 out(0.0f), right(0.0f);
            out[axis] = right[(axis + 1) % 3] = 0.5f * side;
            out *= sign;
            const glm::vec3 up = glm::cross(out, right) / (0.5f * side);
            cube.add(out - right - up, out + right - up, out + right + up);
            cube.add(out - right - up, out + right + up, out - right + up);
        }
    return cube;
}

std::size_t viewTowards(const SurfaceViews& views, const glm::vec3& direction)
{
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        if (glm::distance(views.towards(view), glm::normalize(direction)) < 1e-5f) return view;
    ADD_FAILURE() << "no such view";
    return 0;
}

SurfaceViews::Cell cellOf(std::size_t index)
{
    const auto across = static_cast<std::size_t>(SurfaceViews::cellsAcross);
    return {static_cast<int>(index % across), static_cast<int>(index / across)};
}

/// The cells by triangle; the last: none.
std::vector<std::size_t> countsOf(const std::vector<Seen>& cells, std::size_t triangleCount)
{
    EXPECT_EQ(cells.size(), cellsOfView);
    std::vector<std::size_t> counts(triangleCount + 1);
    for (const Seen& cell : cells)
        ++counts[cell.triangle == Seen::none ? triangleCount : cell.triangle];
    return counts;
}

TEST(SurfaceViewsTest, aCubeCoversSquaresAndRectangles)
{
    // A view is 1.2 times as wide as the surface: 80 of 96 cells. Between two axes a cube is sqrt(2) times as wide as
    // high.
    const double ofRectangle = 6400.0 / std::sqrt(2.0);
    const Triangles cube = makeCube(2.0f);
    const SurfaceViews views(cube.poses);
    std::size_t covered = 0;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        EXPECT_NEAR(glm::length(views.towards(view)), 1.0f, 1e-6f);
        const glm::vec3 along = glm::abs(views.towards(view));
        const bool isAlongAxis = std::max({along.x, along.y, along.z}) > 0.9f;
        std::size_t count = 0;
        for (const Seen& seen : views.seen(view, cube.surface()))
        {
            if (seen.triangle == Seen::none) continue;
            ++count;
            glm::vec3 out(0.0f);
            out[static_cast<int>(seen.triangle / 4)] = seen.triangle / 2 % 2 == 0 ? -1.0f : 1.0f;
            ASSERT_GT(glm::dot(out, views.towards(view)), 0.5f) << "view " << view << " of triangle " << seen.triangle;
        }
        EXPECT_NEAR(static_cast<double>(count), isAlongAxis ? 6400.0 : ofRectangle,
                    isAlongAxis ? 0.0 : 0.01 * ofRectangle)
            << view;
        covered += count;
    }
    EXPECT_EQ(views.coveredCells(cube.surface()), covered);
    EXPECT_EQ(views.coveredCells(makeCube(6.0f).surface()), SurfaceViews::viewCount * cellsOfView)
        << "a surface beyond the grids is cut";
    const Triangles point = makeCube(0.0f);
    EXPECT_EQ(SurfaceViews(point.poses).coveredCells(point.surface(true)), 0u);
}

TEST(SurfaceViewsTest, eachViewShowsAnotherPose)
{
    for (const std::size_t poseCount : {std::size_t(1), std::size_t(4), SurfaceViews::poseCount + 5})
    {
        const SurfaceViews::Poses poses(poseCount, makeCube(2.0f).poses[0]);
        const SurfaceViews views(poses);
        std::set<std::size_t> shown;
        for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        {
            shown.insert(views.poseOf(view));
            SurfaceViews::Poses elsewhere(poseCount, std::vector<glm::vec3>(poses[0].size(), glm::vec3(1e6f)));
            elsewhere[views.poseOf(view)] = poses[0];
            EXPECT_LT(countsOf(views.seen(view, {elsewhere, makeCube(2.0f).indices, true}), 12)[12], 5000u) << view;
        }
        EXPECT_EQ(shown.size(), std::clamp(poseCount - 1, std::size_t(1), SurfaceViews::viewCount));
        EXPECT_EQ(shown.count(0), poseCount == 1) << "the first pose, if there is no other";
    }
}

TEST(SurfaceViewsTest, theNearestTriangleWinsAndOneSidedOnesAreNotVisibleFromBehind)
{
    for (const bool isNearestFirst : {false, true})
        for (const bool isTwoSided : {false, true})
        {
            SCOPED_TRACE(std::string(isNearestFirst ? "nearest first" : "") + (isTwoSided ? ", two-sided" : ""));
            Triangles squares;
            squares.addSquare({-1, -1, isNearestFirst ? 1 : 0}, isNearestFirst ? 1.0f : 2.0f);
            squares.addSquare({-1, -1, isNearestFirst ? 0 : 1}, isNearestFirst ? 2.0f : 1.0f);
            const SurfaceViews views(squares.poses);
            const std::size_t near = isNearestFirst ? 0 : 2, far = 2 - near;
            for (const float side : {1.0f, -1.0f})
            {
                const std::vector<Seen> cells =
                    views.seen(viewTowards(views, {0, 0, side}), squares.surface(isTwoSided));
                const std::vector<std::size_t> counts = countsOf(cells, 4);
                EXPECT_EQ(counts[near] + counts[near + 1], side > 0.0f ? 1600u : 0u);
                EXPECT_EQ(counts[far] + counts[far + 1], side > 0.0f ? 4800u : isTwoSided ? 6400u : 0u);
                for (const Seen& seen : cells)
                    EXPECT_TRUE(seen.triangle == Seen::none || seen.isFront == (side > 0.0f));
            }
            const std::size_t edge = viewTowards(views, {1, 0, 0});
            EXPECT_EQ(countsOf(views.seen(edge, squares.surface(isTwoSided)), 4)[4], cellsOfView);
        }
}

TEST(SurfaceViewsTest, theOutlineSurroundsWhatIsVisible)
{
    Triangles square;
    square.addSquare({0, 0, 0}, 1.0f);
    const SurfaceViews views(square.poses);
    const std::size_t view = viewTowards(views, {0, 0, 1});
    const std::vector<SurfaceViews::Cell> outline = SurfaceViews::outlineOf(views.seen(view, square.surface()));
    EXPECT_EQ(outline.size(), 4u * 79u);
    std::set<std::size_t> indices;
    for (const SurfaceViews::Cell& cell : outline)
        indices.insert(SurfaceViews::indexOf(cell));
    const glm::vec3 diagonal = views.wayBetween(view, cellOf(*indices.begin()), cellOf(*indices.rbegin()));
    EXPECT_LT(glm::distance(diagonal, glm::vec3(79.0f / 80.0f, 79.0f / 80.0f, 0.0f)), 1e-4f);
    EXPECT_TRUE(SurfaceViews::outlineOf(views.seen(viewTowards(views, {0, 0, -1}), square.surface())).empty());
}

constexpr unsigned char fourTexels[] = {255, 0, 0,   0,  255, 0,
                                        0,   0, 255, 51, 102, 204}; ///< from the lower left one, RGB

/// A picture of two by two texels of up to three bytes.
osg::ref_ptr<osg::Texture2D> makeMap(GLenum format = GL_RGB)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, format, GL_UNSIGNED_BYTE);
    std::copy_n(std::begin(fourTexels), image->getTotalSizeInBytes(), image->data());
    osg::ref_ptr<osg::Texture2D> map = new osg::Texture2D(image);
    for (const auto wrap : {osg::Texture::WRAP_S, osg::Texture::WRAP_T})
        map->setWrap(wrap, osg::Texture::REPEAT);
    return map;
}

/// A lit square with a picture: vertex i shows texel i of the lower left, lower right, upper right and upper left ones.
osg::ref_ptr<SkinnedGeometry> makeSquare()
{
    osg::ref_ptr<SkinnedGeometry> square = makeTestSquare(1);
    square->setColorArray(nullptr);
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    for (const osg::Vec2 corner :
         {osg::Vec2(0.25f, 0.25f), osg::Vec2(0.75f, 0.25f), osg::Vec2(0.75f, 0.75f), osg::Vec2(0.25f, 0.75f)})
        coordinates->push_back(corner);
    square->setTexCoordArray(0, coordinates);
    square->getOrCreateStateSet()->setTextureAttributeAndModes(0, makeMap());
    return square;
}

osg::Image& pictureOf(osg::StateSet& state)
{
    return *static_cast<osg::Texture2D&>(*state.getTextureAttribute(0, osg::StateAttribute::TEXTURE)).getImage();
}

void makePbr(SkinnedGeometry& mesh, PbrMaterial::Map PbrMaterial::*map, int coordinates)
{
    PbrMaterial material;
    material.emissive.set(1, 1, 1);
    material.clearcoat = material.transmission = 0.5f;
    material.sheenColor.set(1, 1, 1);
    material.hasMoreCoordinates = coordinates > 0;
    (material.*map) = {makeMap(), coordinates};
    applyPbrMaterial(*mesh.getStateSet(), material);
    // What transmission adds: the map alone is tested.
    mesh.getStateSet()->removeAttribute(osg::StateAttribute::BLENDFUNC);
    mesh.getStateSet()->removeMode(GL_BLEND);
    mesh.getStateSet()->setRenderingHint(osg::StateSet::DEFAULT_BIN);
}

using Mesh = SkinnedGeometry;
using State = osg::StateSet;

struct MaterialCase
{
    const char* name;
    bool isTaken;
    void (*change)(Mesh&, State&);
};

constexpr osg::Array::Binding eachVertex = osg::Array::BIND_PER_VERTEX;

/// Red for each of four vertices.
osg::ref_ptr<osg::Vec4ubArray> bytes(bool isNormalized)
{
    osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray(eachVertex);
    colors->assign(4, osg::Vec4ub(255, 0, 0, 255));
    colors->setNormalize(isNormalized);
    return colors;
}

const MaterialCase materialCases[] = {
    {"a picture", true, [](Mesh&, State&) {}},
    {"white", true,
     [](Mesh& mesh, State& state)
     {
         mesh.setTexCoordArray(0, nullptr);
         state.removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
         applyCharacterProgram(state);
     }},
    {"grey", true, [](Mesh&, State& state) { state.setTextureAttribute(0, makeMap(GL_LUMINANCE_ALPHA)); }},
    {"two-sided", true, [](Mesh&, State& state) { state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF); }},
    {"culled from behind", true, [](Mesh&, State& state) { state.setAttributeAndModes(new osg::CullFace); }},
    {"colours", true, [](Mesh& mesh, State&) { mesh.setColorArray(new osg::Vec4Array(eachVertex, 4)); }},
    {"colours in bytes", true, [](Mesh& mesh, State&) { mesh.setColorArray(bytes(true)); }},
    {"one colour", true,
     [](Mesh& mesh, State&) { mesh.setColorArray(new osg::Vec4Array(osg::Array::BIND_OVERALL, 1)); }},

    {"no state", false, [](Mesh& mesh, State&) { mesh.setStateSet(nullptr); }},
    {"no program", false, [](Mesh&, State& state) { state.removeAttribute(osg::StateAttribute::PROGRAM); }},
    {"a program of its own", false, [](Mesh&, State& state) { state.setAttribute(new osg::Program); }},
    {"holes", false, [](Mesh&, State& state) { state.getUniform("alphaCutoff")->set(0.5f); }},
    {"blending", false, [](Mesh&, State& state) { applyBlending(state, GL_SRC_ALPHA); }},
    {"blending in the order of the scene", false,
     [](Mesh&, State& state) { state.setAttributeAndModes(new osg::BlendFunc); }},
    {"a bin of its own", false, [](Mesh&, State& state) { state.setRenderBinDetails(3, "RenderBin"); }},
    {"culled from the front", false,
     [](Mesh&, State& state) { state.setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT)); }},
    {"clockwise", false,
     [](Mesh&, State& state) { state.setAttribute(new osg::FrontFace(osg::FrontFace::CLOCKWISE)); }},
    {"a texture matrix", false, [](Mesh&, State& state) { state.setTextureAttribute(0, new osg::TexMat); }},
    {"an animated texture transform", false,
     [](Mesh&, State& state) { state.setDefine("MATERIAL_TEXTURE_TRANSFORM"); }},
    {"no picture", false, [](Mesh&, State& state) { state.setTextureAttribute(0, new osg::Texture2D); }},
    {"a picture that is gone", false,
     [](Mesh&, State& state) { state.setTextureAttribute(0, new osg::Texture2D(new osg::Image)); }},
    {"a compressed picture", false,
     [](Mesh&, State& state) { pictureOf(state).setPixelFormat(GL_COMPRESSED_RGB_S3TC_DXT1_EXT); }},
    {"a picture of floats", false,
     [](Mesh&, State& state) { pictureOf(state).allocateImage(2, 2, 1, GL_RGB, GL_FLOAT); }},
    {"a picture that changes", false,
     [](Mesh&, State& state) { pictureOf(state).setDataVariance(osg::Object::DYNAMIC); }},
    {"a film", false,
     [](Mesh&, State& state)
     {
         osg::ref_ptr<osg::ImageStream> film = new osg::ImageStream;
         film->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
         state.setTextureAttribute(0, new osg::Texture2D(film));
     }},
    {"no coordinates", false, [](Mesh& mesh, State&) { mesh.setTexCoordArray(0, nullptr); }},
    {"too few coordinates", false, [](Mesh& mesh, State&) { mesh.setTexCoordArray(0, new osg::Vec2Array(3)); }},
    {"too few colours", false, [](Mesh& mesh, State&) { mesh.setColorArray(new osg::Vec4Array(eachVertex, 3)); }},
    {"colours without alpha", false, [](Mesh& mesh, State&) { mesh.setColorArray(new osg::Vec3Array(eachVertex, 4)); }},
    {"colours up to 255", false, [](Mesh& mesh, State&) { mesh.setColorArray(bytes(false)); }},
};

struct MapCase
{
    PbrMaterial::Map PbrMaterial::*map;
    int coordinates;
    bool isTaken;
};

const MapCase mapCases[] = {
    {&PbrMaterial::baseColorMap, 0, true},      {&PbrMaterial::metallicRoughnessMap, 0, true},
    {&PbrMaterial::occlusionMap, 1, true},      {&PbrMaterial::normalMap, 1, true},
    {&PbrMaterial::emissiveMap, 0, false},      {&PbrMaterial::metallicRoughnessMap, 1, false},
    {&PbrMaterial::specularColorMap, 0, false}, {&PbrMaterial::clearcoatMap, 0, false},
    {&PbrMaterial::sheenColorMap, 0, false},    {&PbrMaterial::transmissionMap, 0, false},
};

TEST(SurfaceColorTest, takesMaterialsThatVertexColoursReplace)
{
    for (const MaterialCase& material : materialCases)
    {
        const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
        material.change(*square, *square->getStateSet());
        EXPECT_EQ(SurfaceColor::of(*square).has_value(), material.isTaken) << material.name;
    }
    for (const MapCase& each : mapCases)
    {
        const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
        makePbr(*square, each.map, each.coordinates);
        EXPECT_EQ(SurfaceColor::of(*square).has_value(), each.isTaken) << "map " << &each - mapCases;
    }
}

void expectColor(const osg::Vec4& found, const osg::Vec4& expected, const char* what)
{
    for (int channel = 0; channel < 4; ++channel)
        EXPECT_NEAR(found[channel], expected[channel], 1e-5f) << what << ", channel " << channel;
}

TEST(SurfaceColorTest, isTheTexelTimesTheColourOfTheVertices)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(eachVertex);
    for (const osg::Vec4 color : {osg::Vec4(1, 1, 1, 1), osg::Vec4(0.5f, 0.5f, 0.5f, 0.5f),
                                  osg::Vec4(0.5f, 0.25f, 1, 1), osg::Vec4(0, 0, 0.2f, 1)})
        colors->push_back(color);
    square->setColorArray(colors);
    const osg::Vec4 last(0.2f, 0.4f, 0.8f, 1); // of the picture
    const osg::Vec4 ofLast(0.5f, 0.25f, 1, 1);
    const glm::vec3 corner(1, 0, 0), middle(0.0f, 0.5f, 0.5f);

    const SurfaceColor display = *SurfaceColor::of(*square);
    expectColor(display.at({0, 1, 2}, corner).color, {1, 0, 0, 1}, "lower left");
    expectColor(display.at({1, 0, 0}, corner).color, {0, 0.5f, 0, 1}, "lower right: alpha does not count");
    expectColor(display.at({2, 0, 0}, corner).color, osg::componentMultiply(last, ofLast), "upper right");
    // The coordinates are (0.5, 0.25 to 0.75) there: the right half of the picture.
    expectColor(display.at({0, 2, 3}, middle).color, {0.2f * 0.25f, 0.4f * 0.125f, 0.8f * 0.6f, 1}, "means");
    expectColor(display.stored({0.1f, 0.2f, 0.3f, 1}), {0.1f, 0.2f, 0.3f, 1}, "display");
    EXPECT_EQ(display.at({0, 1, 2}, corner).metallicRoughness, osg::Vec2(1, 1));

    PbrMaterial material;
    material.baseColorMap.texture = makeMap();
    material.metallicRoughnessMap.texture = makeMap();
    applyPbrMaterial(*square->getStateSet(), material);
    const SurfaceColor linear = *SurfaceColor::of(*square);
    expectColor(linear.at({2, 0, 0}, corner).color, osg::componentMultiply(linearColor(last), linearColor(ofLast)),
                "linear light");
    expectColor(linear.stored(linearColor(last)), last, "stored for the display");
    const osg::Vec2 metallicRoughness = linear.at({2, 0, 0}, corner).metallicRoughness;
    EXPECT_NEAR(metallicRoughness.x(), 0.8f, 1e-5f) << "blue is metallic";
    EXPECT_NEAR(metallicRoughness.y(), 0.4f, 1e-5f) << "green is roughness";
}

TEST(SurfaceColorTest, picturesRepeat)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
    auto& coordinates = static_cast<osg::Vec2Array&>(*square->getTexCoordArray(0));
    const auto colorAt = [&](float x, float y)
    {
        coordinates[0].set(x, y);
        return SurfaceColor::of(*square)->at({0, 0, 0}, {1, 0, 0}).color;
    };
    expectColor(colorAt(-0.25f, 0.25f), {0, 1, 0, 1}, "left of it");
    expectColor(colorAt(3.75f, -1.25f), {0.2f, 0.4f, 0.8f, 1}, "right of it and below");
    expectColor(colorAt(1.0f, -1e-9f), {0, 0, 1, 1}, "its border");
    expectColor(colorAt(std::nanf(""), 1e30f), {1, 0, 0, 1}, "not a number: some texel");
}

TEST(SurfaceColorTest, theNewStateHasTheMaterialWithoutItsMaps)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
    State& former = *square->getStateSet();
    PbrMaterial material;
    material.baseColor.set(0.5f, 0.25f, 1, 1);
    material.metallic = 0.5f;
    material.roughness = 0.8f;
    for (const auto map : {&PbrMaterial::baseColorMap, &PbrMaterial::metallicRoughnessMap, &PbrMaterial::occlusionMap,
                           &PbrMaterial::normalMap})
        (material.*map).texture = makeMap();
    former.setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
    former.setAttribute(new osg::Fog); // what an application changes later shows at all levels
    applyPbrMaterial(former, material);
    const osg::ref_ptr<osg::StateSet> state = SurfaceColor::flatState(former, 3, {0.5f, 0.25f});
    const std::optional<PbrMaterial> made = pbrMaterialOf(*state);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->baseColor, material.baseColor);
    EXPECT_FLOAT_EQ(made->metallic, 0.25f);
    EXPECT_FLOAT_EQ(made->roughness, 0.2f);
    for (const auto map : {&PbrMaterial::metallicRoughnessMap, &PbrMaterial::occlusionMap, &PbrMaterial::normalMap})
        EXPECT_EQ((*made.*map).texture, nullptr);
    EXPECT_NE(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE), material.baseColorMap.texture);
    EXPECT_TRUE(state->getMode(GL_CULL_FACE) & osg::StateAttribute::ON) << "the merged surface has one side";
    for (const auto type : {osg::StateAttribute::PROGRAM, osg::StateAttribute::FOG})
        EXPECT_EQ(state->getAttribute(type), former.getAttribute(type));
    EXPECT_EQ(state->getUniform("unlit"), former.getUniform("unlit"));
    EXPECT_EQ(pbrMaterialOf(former)->normalMap.texture, material.normalMap.texture) << "the mesh's own is as before";
}

} // namespace

} // namespace osgGpuAnimation
