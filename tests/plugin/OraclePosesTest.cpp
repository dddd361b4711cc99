// SPDX-License-Identifier: MIT
#include "gltf/ModelImport.h"
#include "plugin/ModelVertices.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

// Compares every real character in every known pose with an evaluation of the specification in double precision (schema
// gltf-pose/1).

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// See modelFile(); how many files of poses below oracle/ have a name that begins with the asset's.
using OracleCase = std::pair<std::string, std::size_t>;

class OraclePosesTest : public ::testing::TestWithParam<OracleCase>
{
protected:
    void compareNodes(const Json& frame, const ImportedModel& model, const ModelVertices& pose) const
    {
        for (std::size_t node = 0; node < frame["nodes"].size(); ++node)
        {
            const int joint = model.set->skeleton().jointOfSourceNode(static_cast<int>(node));
            if (joint < 0) continue;
            SCOPED_TRACE("node " + std::to_string(node));
            compareMatrix(frame["nodes"][node], pose.jointToModel()[static_cast<std::size_t>(joint)]);
        }
    }

    void compareMatrix(const Json& expected, const AffineMatrix& found) const
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

    void comparePrimitives(const Json& frame, const ImportedModel& model, const ModelVertices& pose) const
    {
        ASSERT_EQ(poses["primitives"].size(), model.primitives.size());
        for (std::size_t index = 0; index < model.primitives.size(); ++index)
        {
            const ImportedPrimitive& primitive = model.primitives[index];
            const Json& about = poses["primitives"][index];
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

    void comparePoint(const Json& expected, const glm::dvec3& found) const
    {
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(expected[axis].get<double>(), found[axis], tolerance * modelSize) << "axis " << axis;
    }

    void compareAll(const ImportedModel& model) const
    {
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
        for (const Json& fixed : poses["fixedWeights"])
            fixedWeights[fixed["node"]] = fixed["weights"].get<std::vector<double>>();
        ASSERT_FALSE(poses["frames"].empty());
        for (const Json& frame : poses["frames"])
        {
            SCOPED_TRACE("time " + frame["time"].dump() + " (" + frame["label"].get<std::string>() + ")");
            const ModelVertices pose(model, clip, frame["time"], fixedWeights);
            compareNodes(frame, model, pose);
            comparePrimitives(frame, model, pose);
        }
    }

    Json poses;
    double modelSize = 1.0, tolerance = 1e-5;
};

} // namespace

TEST_P(OraclePosesTest, everyFrameIsWhatTheSpecificationSays)
{
    ImportOptions options;
    options.noRotation = true;
    ImportedModel model;
    importOrSkip(GetParam().first, model, options);
    if (IsSkipped() || HasFatalFailure()) return;
    std::size_t posings = 0;
    for (const auto& entry : std::filesystem::directory_iterator(OSGGPUANIMATION_SHARED_ASSETS "/oracle"))
    {
        const std::string name = entry.path().filename().string();
        if (name.rfind(nameOfFile(GetParam().first) + '.', 0) != 0 || entry.path().extension() != ".json") continue;
        SCOPED_TRACE(name);
        ++posings;
        poses = Json::parse(readBytes(entry.path().string()));
        modelSize = poses["modelSize"];
        tolerance = 1e-5; // float32 throughout; the tolerance of the poses' own comparison program
        if (poses.contains("ambiguity") && poses["ambiguity"].is_object())
            tolerance += poses["ambiguity"]["relative"].get<double>();
        compareAll(model);
    }
    EXPECT_EQ(posings, GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(Assets, OraclePosesTest,
                         ::testing::Values(OracleCase{"assets/AnimatedMorphCube/AnimatedMorphCube.gltf", 3},
                                           OracleCase{"assets/CesiumMan/CesiumMan.glb", 2},
                                           OracleCase{"assets/Fox/Fox.glb", 4},
                                           OracleCase{"assets/Knight/Knight.glb", 4},
                                           OracleCase{"assets/SimpleSkin/SimpleSkin.gltf", 2},
                                           OracleCase{"assets/interpolation_test/interpolation_test.gltf", 9},
                                           OracleCase{"assets/probe/probe.gltf", 4},
                                           OracleCase{"assets/rigged_simple/rigged_simple.gltf", 2}),
                         [](const auto& info) { return nameOfFile(info.param.first); });

} // namespace osgGpuAnimation::gltf
