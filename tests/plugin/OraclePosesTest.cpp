// SPDX-License-Identifier: MIT
#include "plugin/ModelVertices.h"
#include "plugin/SharedAssets.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

// Compares every real character in every known pose with an evaluation of the specification in double precision (schema
// gltf-pose/1).

namespace osgGpuAnimation::gltf
{

namespace
{

using nlohmann::json;

struct OracleCase
{
    const char* asset; ///< below assets/
    const char* poses; ///< below oracle/
};

const OracleCase cases[] = {
    {"AnimatedMorphCube/AnimatedMorphCube.gltf", "AnimatedMorphCube.0_Square"},
    {"AnimatedMorphCube/AnimatedMorphCube.gltf", "AnimatedMorphCube.bind"},
    {"AnimatedMorphCube/AnimatedMorphCube.gltf", "AnimatedMorphCube.weights"},
    {"CesiumMan/CesiumMan.glb", "CesiumMan.0"},
    {"CesiumMan/CesiumMan.glb", "CesiumMan.bind"},
    {"Fox/Fox.glb", "Fox.0_Survey"},
    {"Fox/Fox.glb", "Fox.1_Walk"},
    {"Fox/Fox.glb", "Fox.2_Run"},
    {"Fox/Fox.glb", "Fox.bind"},
    {"Knight/Knight.glb", "Knight.0_1H_Melee_Attack_Chop"},
    {"Knight/Knight.glb", "Knight.36_Idle"},
    {"Knight/Knight.glb", "Knight.72_Walking_A"},
    {"Knight/Knight.glb", "Knight.bind"},
    {"SimpleSkin/SimpleSkin.gltf", "SimpleSkin.0"},
    {"SimpleSkin/SimpleSkin.gltf", "SimpleSkin.bind"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.0_Step_Scale"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.1_Linear_Scale"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.2_CubicSpline_Scale"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.3_Step_Rotation"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.4_CubicSpline_Rotation"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.5_Linear_Rotation"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.6_Step_Translation"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.7_CubicSpline_Translation"},
    {"interpolation_test/interpolation_test.gltf", "interpolation_test.8_Linear_Translation"},
    {"probe/probe.gltf", "probe.0_spline"},
    {"probe/probe.gltf", "probe.1_mixed"},
    {"probe/probe.gltf", "probe.2_short_rotations"},
    {"probe/probe.gltf", "probe.bind"},
    {"rigged_simple/rigged_simple.gltf", "rigged_simple.0"},
    {"rigged_simple/rigged_simple.gltf", "rigged_simple.bind"},
};

class OraclePosesTest : public ::testing::TestWithParam<OracleCase>
{
protected:
    void compareNodes(const json& frame, const ImportedModel& model, const ModelVertices& pose) const
    {
        for (std::size_t node = 0; node < frame["nodes"].size(); ++node)
        {
            const int joint = model.set->skeleton().jointOfSourceNode(static_cast<int>(node));
            if (joint < 0) continue;
            SCOPED_TRACE("node " + std::to_string(node));
            compareMatrix(frame["nodes"][node], pose.jointToModel()[static_cast<std::size_t>(joint)]);
        }
    }

    void compareSkins(const json& frame, const ImportedModel& model, const ModelVertices& pose) const
    {
        for (std::size_t skin = 0; skin < frame["skins"].size(); ++skin)
        {
            for (std::size_t place = 0; place < frame["skins"][skin].size(); ++place)
            {
                SCOPED_TRACE("skin " + std::to_string(skin) + " joint " + std::to_string(place));
                const int entry = model.set->entryOfSkin(skin, place);
                compareMatrix(frame["skins"][skin][place], pose.palette()[static_cast<std::size_t>(entry)]);
            }
        }
    }

    void compareMatrix(const json& expected, const AffineMatrix& found) const
    {
        double linear = 1.0;
        double length = modelSize;
        for (int i = 0; i < 12; ++i)
            linear = std::max(linear, i % 4 == 3 ? 0.0 : std::abs(expected[i].get<double>()));
        for (int i = 12; i < 15; ++i)
            length = std::max(length, std::abs(expected[i].get<double>()));
        for (int i = 0; i < 16; ++i)
        {
            if (i % 4 == 3) continue;
            const double scale = i < 12 ? linear : length;
            ASSERT_NEAR(expected[i].get<double>(), found.rows[static_cast<std::size_t>(i % 4)][i / 4],
                        tolerance * scale)
                << "element " << i;
        }
    }

    void comparePrimitives(const json& frame, const ImportedModel& model, const ModelVertices& pose) const
    {
        ASSERT_EQ(poses["primitives"].size(), model.primitives.size());
        for (std::size_t index = 0; index < model.primitives.size(); ++index)
        {
            const ImportedPrimitive& primitive = model.primitives[index];
            const json& about = poses["primitives"][index];
            SCOPED_TRACE("primitive " + std::to_string(index));
            ASSERT_EQ(about["node"], primitive.node);
            ASSERT_EQ(about["primitive"], primitive.primitives->front());
            ASSERT_EQ(about["skin"].is_null() ? -1 : about["skin"].get<int>(), primitive.skin);
            ASSERT_EQ(about["targets"], primitive.targets);
            ASSERT_EQ(about["vertices"], primitive.vertexCount);
            ASSERT_EQ(about["influences"], primitive.influences);
            const std::vector<glm::dvec3> positions = pose.positions(primitive);
            for (std::size_t i = 0; i < about["sampled"].size(); ++i)
                comparePoint(frame["primitives"][index]["positions"][i], positions[about["sampled"][i]]);
            glm::dvec3 low(1e300), high(-1e300);
            for (const glm::dvec3& position : positions)
            {
                low = glm::min(low, position);
                high = glm::max(high, position);
            }
            comparePoint(frame["primitives"][index]["bbox"][0], low);
            comparePoint(frame["primitives"][index]["bbox"][1], high);
        }
    }

    void comparePoint(const json& expected, const glm::dvec3& found) const
    {
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(expected[axis].get<double>(), found[axis], tolerance * modelSize) << "axis " << axis;
    }

    void compareWeights(const json& frame, const ImportedModel& model, const ModelVertices& pose) const
    {
        for (const json& expected : frame["weights"])
        {
            const auto& morphs = model.set->morphs();
            const auto morph = std::find_if(morphs.begin(), morphs.end(),
                                            [&](const MorphWeights& m) { return m.sourceNode == expected["node"]; });
            ASSERT_NE(morph, morphs.end());
            const std::vector<double> found = pose.weights(static_cast<int>(morph - morphs.begin()));
            ASSERT_EQ(expected["weights"].size(), found.size());
            for (std::size_t i = 0; i < found.size(); ++i)
                EXPECT_NEAR(expected["weights"][i].get<double>(), found[i], tolerance);
        }
    }

    json poses;
    double modelSize = 1.0;
    double tolerance = 1e-5; // float32 throughout; the tolerance of the poses' own comparison program
};

} // namespace

TEST_P(OraclePosesTest, everyFrameIsWhatTheSpecificationSays)
{
    const std::string assetName = std::string("assets/") + GetParam().asset;
    const std::string posesName = std::string("oracle/") + GetParam().poses + ".json";
    SKIP_WITHOUT_SHARED_FILE(assetName);
    SKIP_WITHOUT_SHARED_FILE(posesName);
    poses = json::parse(readBytes(sharedFile(posesName)));
    modelSize = poses["modelSize"];
    if (poses.contains("ambiguity") && poses["ambiguity"].is_object())
        tolerance += poses["ambiguity"]["relative"].get<double>();

    ImportOptions options;
    options.noRotation = true;
    const std::string asset = sharedFile(assetName);
    const Result<ImportedModel> imported = importModel(readBytes(asset), asset, options);
    ASSERT_TRUE(imported) << imported.error().message;
    const ImportedModel& model = imported.value();
    int clip = -1;
    if (poses["clip"].is_object())
    {
        const auto& animations = model.animationOfClip;
        const auto found = std::find(animations.begin(), animations.end(), poses["clip"]["index"].get<int>());
        ASSERT_NE(found, animations.end());
        clip = static_cast<int>(found - animations.begin());
        EXPECT_NEAR(poses["clip"]["duration"].get<double>(), model.set->clips()[clip].duration(), 1e-6);
    }
    std::map<int, std::vector<double>> fixedWeights;
    for (const json& fixed : poses["fixedWeights"])
        fixedWeights[fixed["node"]] = fixed["weights"].get<std::vector<double>>();

    ASSERT_FALSE(poses["frames"].empty());
    for (const json& frame : poses["frames"])
    {
        SCOPED_TRACE("time " + frame["time"].dump() + " (" + frame["label"].get<std::string>() + ")");
        const ModelVertices pose(model, clip, frame["time"], fixedWeights);
        compareNodes(frame, model, pose);
        compareSkins(frame, model, pose);
        compareWeights(frame, model, pose);
        comparePrimitives(frame, model, pose);
    }
}

INSTANTIATE_TEST_SUITE_P(Assets, OraclePosesTest, ::testing::ValuesIn(cases),
                         [](const ::testing::TestParamInfo<OracleCase>& info)
                         {
                             std::string name = info.param.poses;
                             std::replace_if(
                                 name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
                             return name;
                         });

} // namespace osgGpuAnimation::gltf
