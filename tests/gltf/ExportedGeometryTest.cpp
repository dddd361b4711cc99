// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "gltf/ModelBuilder.h"
#include "serializers/RoundTrip.h"

#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osg/CameraView>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;
using Numbers = std::vector<double>;

void expectNumbers(const Numbers& found, const Numbers& expected)
{
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-5) << i;
}

/// The linear light of a displayed colour: IEC 61966-2-1.
double linear(double displayed)
{
    return displayed <= 0.04045 ? displayed / 12.92 : std::pow((displayed + 0.055) / 1.055, 2.4);
}

TEST(ExportedGeometryTest, coloursOfAllArraysAreLinear)
{
    osg::ref_ptr<osg::Vec4ubArray> bytes = new osg::Vec4ubArray;
    osg::ref_ptr<osg::Vec3ubArray> bytesWithoutAlpha = new osg::Vec3ubArray;
    osg::ref_ptr<osg::Vec3Array> floats = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4dArray> doubles = new osg::Vec4dArray;
    Numbers expected, opaque;
    for (int vertex = 0; vertex < 3; ++vertex)
    {
        const auto red = static_cast<unsigned char>(51 * (vertex + 1));
        const double share = 0.2 * (vertex + 1);
        bytes->push_back(osg::Vec4ub(red, 0, 255, 102));
        bytesWithoutAlpha->push_back(osg::Vec3ub(red, 0, 255));
        floats->push_back(osg::Vec3(static_cast<float>(share), -1, 1.5f)); // clamped to [0, 1]
        doubles->push_back(osg::Vec4d(share, 0, 1, 0.4));
        expected.insert(expected.end(), {linear(share), 0, 1, 0.4});
        opaque.insert(opaque.end(), {linear(share), 0, 1, 1});
    }
    const std::pair<osg::Array*, Numbers> cases[] = {
        {bytes, expected}, {doubles, expected}, {bytesWithoutAlpha, opaque}, {floats, opaque}};
    for (const auto& [array, wanted] : cases)
        for (const bool isOfEach : {true, false})
        {
            SCOPED_TRACE(std::string(array->className()) + (isOfEach ? " per vertex" : " overall"));
            const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("coloured");
            osg::ref_ptr<osg::Material> material = new osg::Material; // OSG shows the colours in its place
            material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.5f, 0.5f, 0.5f, 1));
            material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
            geometry->getOrCreateStateSet()->setAttribute(material);
            geometry->setColorArray(array, isOfEach ? osg::Array::BIND_PER_VERTEX : osg::Array::BIND_OVERALL);
            Numbers all = wanted;
            for (std::size_t i = 4; !isOfEach && i < all.size(); ++i)
                all[i] = all[i - 4];
            const GlbParts made = exported(*geometry);
            expectNumbers(made.attribute("COLOR_0"), all);
            EXPECT_EQ(made.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], Json({1, 1, 1, 1}));
        }
    const osg::ref_ptr<osg::Geometry> hidden = plainTriangle("hidden colours");
    hidden->setColorArray(bytes, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::OFF);
    hidden->getOrCreateStateSet()->setAttribute(material);
    EXPECT_TRUE(exported(*hidden).attribute("COLOR_0").empty());
}

TEST(ExportedGeometryTest, arraysOfVerticesKeepTheirPlacesAndDirections)
{
    const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("triangle");
    const osg::Vec3 normals[] = {{0, -2, 0}, {0, 0, 0}, {0, 0, 4}};
    geometry->setNormalArray(new osg::Vec3Array(3, normals), osg::Array::BIND_PER_VERTEX);
    const osg::Vec4 tangents[] = {{3, 0, 0, -1}, {0, 0, 2, 1}, {1, 0, 0, -0.5f}};
    geometry->setVertexAttribArray(4, new osg::Vec4Array(3, tangents), osg::Array::BIND_PER_VERTEX);
    const osg::Vec2 first[] = {{0, 0.25f}, {1, 0}, {0.5f, 1}};
    geometry->setTexCoordArray(0, new osg::Vec2Array(3, first), osg::Array::BIND_PER_VERTEX);
    const osg::Vec4 more[] = {{0.1f, 0.2f, 0.3f, 0.4f}, {0.5f, 0.6f, 0.7f, 0.8f}, {0, 0, 1, 1}};
    geometry->setVertexAttribArray(9, new osg::Vec4Array(3, more), osg::Array::BIND_PER_VERTEX);
    const GlbParts made = exported(*geometry);
    expectNumbers(made.attribute("NORMAL"), {0, -1, 0, 0, 0, 1, 0, 0, 1});
    expectNumbers(made.attribute("TANGENT"), {1, 0, 0, -1, 0, 0, 1, 1, 1, 0, 0, -1});
    expectNumbers(made.attribute("TEXCOORD_0"), {0, 0.75, 1, 1, 0.5, 0});
    expectNumbers(made.attribute("TEXCOORD_1"), {0.1, 0.8, 0.5, 0.4, 0, 1});
    expectNumbers(made.attribute("TEXCOORD_2"), {0.3, 0.6, 0.7, 0.2, 1, 0});
    const Json& bounds =
        made.json["accessors"][made.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(bounds["min"], Json({0, 0, 0}));
    EXPECT_EQ(bounds["max"], Json({1, 0, 1}));
}

/// A position of two components has z = 0; what is too long is cut to the vertices.
TEST(ExportedGeometryTest, arraysOfOtherKindsAndLengthsAreMended)
{
    const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("flat");
    const osg::Vec2 corners[] = {{0, 0}, {1, 0}, {0, 1}};
    geometry->setVertexArray(new osg::Vec2Array(3, corners));
    geometry->setNormalArray(new osg::Vec3bArray(3), osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, new osg::Vec2Array(osg::Array::BIND_PER_VERTEX, 5));
    const GlbParts made =
        exported(*geometry, {"mesh \"flat\": NORMAL is an array of a kind that is not read (Vec3bArray); left out"});
    expectNumbers(made.attribute("POSITION"), {0, 0, 0, 1, 0, 0, 0, 1, 0});
    EXPECT_EQ(made.attribute("TEXCOORD_0").size(), 6u);
    EXPECT_EQ(made.json["meshes"][0]["primitives"][0]["attributes"].size(), 2u);
}

TEST(ExportedGeometryTest, pointsLinesAndTrianglesAreListsOfTheirOwn)
{
    const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("mixed");
    geometry->setVertexArray(new osg::Vec3Array(4));
    const unsigned short triangle[] = {2, 1, 3}, lines[] = {3, 1, 0, 2};
    geometry->setPrimitiveSet(0, new osg::DrawElementsUShort(GL_TRIANGLES, 3, triangle));
    geometry->addPrimitiveSet(new osg::DrawElementsUShort(GL_LINES, 4, lines));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 2, 1));
    const GlbParts made = exported(*geometry);
    const std::pair<int, Numbers> expected[] = {{4, {2, 1, 3}}, {1, {3, 1, 0, 2}}, {0, {2}}};
    const Json& primitives = made.json["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
    {
        EXPECT_EQ(primitives[i]["mode"], expected[i].first);
        EXPECT_EQ(made.numbers(primitives[i]["indices"]), expected[i].second) << i;
    }
}

struct RunsCase
{
    const char* name;
    GLenum mode;
    std::vector<GLsizei> lengths; ///< of a DrawArrayLengths over eight vertices
    int writtenMode;
    Numbers indices;
};

TEST(ExportedGeometryTest, incompletePrimitivesAreCutOffAndRunsStayApart)
{
    const RunsCase cases[] = {
        {"triangles", GL_TRIANGLES, {4, 3}, 4, {0, 1, 2, 4, 5, 6}},
        {"strips", GL_TRIANGLE_STRIP, {4, 3}, 4, {0, 1, 2, 1, 3, 2, 4, 5, 6}},
        {"fans", GL_TRIANGLE_FAN, {4, 4}, 4, {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}},
        {"polygons", GL_POLYGON, {2, 4}, 4, {2, 3, 4, 2, 4, 5}},
        {"quads", GL_QUADS, {5}, 4, {0, 1, 2, 0, 2, 3}},
        {"strips of quads", GL_QUAD_STRIP, {5, 3}, 4, {0, 1, 2, 1, 3, 2}},
        {"lines", GL_LINES, {5}, 1, {0, 1, 2, 3}},
        {"strips of lines", GL_LINE_STRIP, {2, 3}, 1, {0, 1, 2, 3, 3, 4}},
        {"loops", GL_LINE_LOOP, {2, 3}, 1, {0, 1, 1, 0, 2, 3, 3, 4, 4, 2}},
        {"a strip of lines", GL_LINE_STRIP, {3}, 3, {0, 1, 2}},
    };
    for (const RunsCase& each : cases)
    {
        SCOPED_TRACE(each.name);
        const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("runs");
        geometry->setVertexArray(new osg::Vec3Array(8));
        osg::ref_ptr<osg::DrawArrayLengths> runs = new osg::DrawArrayLengths(each.mode);
        runs->insert(runs->end(), each.lengths.begin(), each.lengths.end());
        geometry->setPrimitiveSet(0, runs);
        const GlbParts made = exported(*geometry);
        const Json& primitive = made.json["meshes"][0]["primitives"][0];
        EXPECT_EQ(primitive["mode"], each.writtenMode);
        EXPECT_EQ(made.numbers(primitive["indices"]), each.indices);
    }
}

/// Influences are scaled to 1, a joint occurs once, and meshes of one joint may differ in their number of vertices.
TEST(ExportedGeometryTest, influencesAreThoseThatGltfAllows)
{
    ModelBuilder file;
    const int joint = file.node("joint");
    const int mesh = file.skinnedTriangle();
    file.primitive(mesh).attributes["JOINTS_0"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0});
    file.primitive(mesh).attributes["WEIGHTS_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.5f, 0.25f, 0.125f, 0.125f, 0.5f, 0.25f, 0.25f, 0, 0.25f, 0.75f, 0, 0});
    file.at(file.node("skinned", -1, mesh)).skin = file.skin({joint, file.node("other", joint)});
    file.slidingClip("move", joint);
    const ImportedModel model = imported(file);
    auto& skinned = dynamic_cast<SkinnedGeometry&>(*model.primitives.front().geometry);
    GlbParts made = exported(*model.root);
    // By joint, whatever the order.
    const auto sums = [&]
    {
        const Numbers joints = made.attribute("JOINTS_0"), weights = made.attribute("WEIGHTS_0");
        Numbers found(6);
        for (std::size_t i = 0; i < joints.size(); ++i)
            found[i / 4 * 2 + static_cast<std::size_t>(joints[i])] += weights[i];
        for (std::size_t vertex = 0; vertex < 3; ++vertex)
            EXPECT_EQ(std::count_if(&weights[4 * vertex], &weights[4 * vertex] + 4, [](double w) { return w > 0; }), 2)
                << "a joint occurs once";
        return found;
    };
    expectNumbers(sums(), {0.625, 0.375, 0.5, 0.5, 0.25, 0.75});
    osg::ref_ptr<osg::Vec4Array> doubled = new osg::Vec4Array(*skinned.getWeights(0));
    (*doubled)[1] *= 2.0f;
    osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(*skinned.getEntries(0));
    skinned.setInfluences(0, entries, doubled);
    made = exported(*model.root, {"mesh \"" + meshNameOf(skinned) +
                                  "\": the weights of 1 vertices do not sum to 1; they are scaled"});
    expectNumbers(sums(), {0.625, 0.375, 0.5, 0.5, 0.25, 0.75});
}

/// The kit stores the changes of colours as displayed and of texture coordinates upwards.
TEST(ExportedGeometryTest, morphTargetsKeepAllTheirChanges)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    tinygltf::Primitive& primitive = file.primitive(mesh);
    primitive.attributes["TEXCOORD_0"] = file.floats(TINYGLTF_TYPE_VEC2, {0, 0, 1, 0, 0, 1});
    primitive.attributes["COLOR_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.1f, 0.2f, 0.3f, 1, 0.5f, 0.5f, 0.5f, 0.5f, 0.2f, 0.4f, 0.6f, 0.8f});
    const Numbers changes[] = {{0, 0, 1, 0, 2, 0, 3, 0, 0},
                               {0, 0, 0.5, 0.25, 0, 0, 0, 0, 0},
                               {0.1, 0.2, 0.3, 0.4, 0, 0.5},
                               {0.2, 0, 0.1, 0, 0.25, 0.25, 0, -0.25, 0, 0.1, 0.2, 0.1}};
    const std::pair<const char*, int> names[] = {{"POSITION", TINYGLTF_TYPE_VEC3},
                                                 {"NORMAL", TINYGLTF_TYPE_VEC3},
                                                 {"TEXCOORD_0", TINYGLTF_TYPE_VEC2},
                                                 {"COLOR_0", TINYGLTF_TYPE_VEC4}};
    primitive.targets.resize(2); // the second is empty
    for (std::size_t i = 0; i < 4; ++i)
        primitive.targets[0][names[i].first] =
            file.floats(names[i].second, std::vector<float>(changes[i].begin(), changes[i].end()));
    primitive.targets[1]["POSITION"] = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(9));
    file.model.textures.resize(1);
    file.model.textures[0].name = "no picture";
    file.model.materials.resize(1);
    file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = 0;
    file.model.materials[0].emissiveFactor = {0, 0, 0};
    primitive.material = 0;
    file.node("mesh", -1, mesh);
    const ImportedModel model = imported(file);
    auto& skinned = dynamic_cast<SkinnedGeometry&>(*model.primitives.front().geometry);
    std::vector<MorphTarget> targets = skinned.getMorphTargets();
    targets[1] = {};
    skinned.setMorphTargets(skinned.getMorph(), skinned.getMorphEntry(), targets);
    const GlbParts made = exported(*model.root);
    const Json& written = made.json["meshes"][0]["primitives"][0]["targets"];
    ASSERT_EQ(written.size(), 2u);
    for (std::size_t i = 0; i < 4; ++i)
    {
        SCOPED_TRACE(names[i].first);
        ASSERT_TRUE(written[0].contains(names[i].first));
        expectNumbers(made.numbers(written[0][names[i].first]), changes[i]);
    }
    ASSERT_TRUE(written[1].contains("POSITION")) << "a target has at least one attribute";
    expectNumbers(made.numbers(written[1]["POSITION"]), Numbers(9));
}

TEST(ExportedGeometryTest, lightsAndCamerasKeepTheirNumbersAndPlaces)
{
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(osg::Matrix::translate(1, 2, 3));
    for (const bool isHidden : {false, true})
    {
        const osg::ref_ptr<PunctualLight> lamp = new PunctualLight(PunctualLight::Kind::Spot, 1);
        ASSERT_TRUE(lamp->setIntensity(osg::Vec3(0.25f, 1.0f, 0.5f), 8.0f));
        ASSERT_TRUE(lamp->setCone(18.0f, 36.0f));
        ASSERT_TRUE(lamp->setRange(12.5f));
        const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->setLight(lamp);
        source->setName(isHidden ? "hidden" : "lamp");
        if (isHidden) source->setNodeMask(0);
        scene->addChild(source);
    }
    const osg::ref_ptr<osg::CameraView> eye = new osg::CameraView;
    eye->setName("eye");
    eye->setPosition(osg::Vec3d(0, 0, 10));
    eye->setUserValue(orthographicHeightName, 6.0);
    scene->addChild(eye);
    const osg::ref_ptr<osg::MatrixTransform> overlay = new osg::MatrixTransform;
    overlay->setName("overlay");
    overlay->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    overlay->addChild(plainTriangle("label"));
    scene->addChild(overlay);
    const Json json = exported(*scene, {"light \"hidden\": it is hidden; left out",
                                        "transform \"overlay\": it has a reference frame of its own; left out"})
                          .json;
    const Json& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_NEAR(lights[0]["intensity"].get<double>(), 8.0, 1e-5);
    EXPECT_NEAR(lights[0]["color"][0].get<double>(), 0.25, 1e-6);
    EXPECT_NEAR(lights[0]["color"][2].get<double>(), 0.5, 1e-6);
    EXPECT_EQ(lights[0]["range"], 12.5);
    EXPECT_NEAR(lights[0]["spot"]["innerConeAngle"].get<double>(), std::acos(-1.0) / 10, 1e-6);
    EXPECT_NEAR(lights[0]["spot"]["outerConeAngle"].get<double>(), std::acos(-1.0) / 5, 1e-6);
    ASSERT_EQ(json["cameras"].size(), 1u);
    EXPECT_EQ(json["cameras"][0]["orthographic"]["ymag"], 3.0) << "half the height";
    EXPECT_EQ(json["cameras"][0]["orthographic"]["xmag"], 3.0);
}

TEST(ExportedGeometryTest, attachmentsKeepTheirOffset)
{
    ModelBuilder file;
    const int arm = file.node("arm");
    file.at(arm).translation = {1, 2, 3};
    file.node("sword", arm, file.triangle());
    file.slidingClip("move", arm);
    const ImportedModel model = imported(file);
    const osg::ref_ptr<JointAttachment> hand = new JointAttachment("arm");
    hand->setOffset(osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(0, 0, 7));
    const osg::ref_ptr<osg::Geometry> ring = plainTriangle("ring");
    hand->addChild(ring);
    findCharacter(*model.root)->addChild(hand);
    const Json json = exported(*model.root).json;
    std::size_t rings = 0;
    for (const Json& node : json["nodes"])
    {
        if (!node.contains("mesh") || json["meshes"][node["mesh"].get<std::size_t>()]["name"] != "ring") continue;
        EXPECT_EQ(node["translation"], Json({0, 0, 7}));
        EXPECT_NEAR(node["rotation"][2].get<double>(), std::sqrt(0.5), 1e-6);
        ++rings;
    }
    EXPECT_EQ(rings, 1u);
}

} // namespace

} // namespace osgGpuAnimation::gltf
