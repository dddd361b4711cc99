// SPDX-License-Identifier: MIT
#include "plugin/LoadedDocument.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// Three lights (one a node) and two cameras.
Json document()
{
    Json made = baseDocument();
    made["extensionsUsed"] = {"KHR_lights_punctual"};
    made["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{"type":"directional","color":[1,0.5,0.25],"intensity":3},{"type":"point","range":9},
                        {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5},"name":"lamp"}])");
    for (int node = 0; node < 3; ++node)
        made["nodes"][node]["extensions"]["KHR_lights_punctual"]["light"] = node;
    made["cameras"] = Json::parse(R"([{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},
                                      {"type":"orthographic","orthographic":{"xmag":1,"ymag":2,"zfar":9,"znear":0}}])");
    made["nodes"][0]["camera"] = 0;
    made["nodes"][1]["camera"] = 1;
    return made;
}

struct Change
{
    const char* path;
    const char* value;   ///< JSON; empty: the member is removed
    const char* message; ///< part of a warning; empty: none
};

const Change changes[] = {
    {"/extensions/KHR_lights_punctual", "7", "lights: expected an array, found nothing; no light is read"},
    {"/extensions", "7", "extensions: expected an object"},
    {"/extensions/KHR_lights_punctual/lights", "{}", "lights: expected an array, found an object"},
    {"/extensions/KHR_lights_punctual/lights/0", "null", "lights[0]: expected an object, found null; the light"},
    {"/extensions/KHR_lights_punctual/lights/0/type", "", "lights[0].type: expected directional, point or spot"},
    {"/extensions/KHR_lights_punctual/lights/0/type", "\"sun\"", "lights[0].type"},
    {"/extensions/KHR_lights_punctual/lights/0/type", "[]", "lights[0].type"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[1,1]", "lights[0].color: expected 3 numbers"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[1,1,-1]", "lights[0].color"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[1,1,1e300]", "lights[0].color"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[1,1,\"x\"]", "lights[0].color"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[2,1,1]", ""},
    {"/extensions/KHR_lights_punctual/lights/0/intensity", "null", "lights[0].intensity: expected a number from 0"},
    {"/extensions/KHR_lights_punctual/lights/0/intensity", "-1", "lights[0].intensity: expected a number from 0"},
    {"/extensions/KHR_lights_punctual/lights/0/intensity", "1e300", "lights[0].intensity"},
    {"/extensions/KHR_lights_punctual/lights/0/intensity", "0", ""},
    {"/extensions/KHR_lights_punctual/lights/0/name", "7", ""},
    {"/extensions/KHR_lights_punctual/lights/1/range", "0",
     "lights[1].range: expected a number above 0, found 0; left"},
    {"/extensions/KHR_lights_punctual/lights/1/spot", "7", ""}, // of no spot
    {"/extensions/KHR_lights_punctual/lights/2/spot", "", "lights[2].spot: expected an object, found nothing"},
    {"/extensions/KHR_lights_punctual/lights/2/spot/outerConeAngle", "2", "lights[2].spot.outerConeAngle"},
    {"/extensions/KHR_lights_punctual/lights/2/spot/outerConeAngle", "\"x\"", "lights[2].spot.outerConeAngle"},
    {"/extensions/KHR_lights_punctual/lights/2/spot/outerConeAngle", "1.5707963267948966", ""},
    {"/extensions/KHR_lights_punctual/lights/2/spot/innerConeAngle", "0.5", "innerConeAngle: expected an angle below"},
    {"/extensions/KHR_lights_punctual/lights/2/spot/innerConeAngle", "-1", "lights[2].spot.innerConeAngle"},
    {"/nodes/0/extensions/KHR_lights_punctual/light", "3", "nodes[0].extensions.KHR_lights_punctual.light: expected"},
    {"/nodes/0/extensions/KHR_lights_punctual/light", "-1", "found -1; left out"},
    {"/nodes/0/extensions/KHR_lights_punctual/light", "0.5", "an index below 3 of the file's lights, found 0.5"},
    {"/nodes/0/extensions/KHR_lights_punctual", "[]", "nodes[0].extensions.KHR_lights_punctual.light"},
    {"/nodes/0/extensions/KHR_lights_punctual/more", "[1,2]", ""},
    {"/cameras/0", "{}", "cameras[0].type: expected perspective or orthographic, found nothing; the camera"},
    {"/cameras/0/type", "\"fisheye\"", "cameras[0].type"},
    {"/cameras/0/type", "\"orthographic\"", "cameras[0].orthographic.ymag: expected a number, not 0, found nothing"},
    {"/cameras/0/perspective", "7", "cameras[0].perspective"},
    {"/cameras/0/perspective/yfov", "0", "cameras[0].perspective.yfov: expected an angle above 0, below pi, found 0"},
    {"/cameras/0/perspective/yfov", "4", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/yfov", "1e300", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/yfov", "null", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/znear", "", ""}, // not read
    {"/cameras/1/orthographic/ymag", "0", "cameras[1].orthographic.ymag"},
    {"/cameras/1/orthographic/ymag", "-2", ""},
};

Json changed(Json made, const Change& change)
{
    const Json::json_pointer place(change.path);
    if (*change.value != '\0')
        made[place] = Json::parse(change.value);
    else
        made[place.parent_pointer()].erase(place.back());
    return made;
}

} // namespace

TEST(ViewRulesTest, aFaultCostsNoMoreThanItsLightOrCamera)
{
    for (const Change& change : changes)
    {
        SCOPED_TRACE(std::string(change.path) + " = " + change.value);
        const LoadedDocument answer = load(changed(document(), change).dump());
        expectAnswer(answer, *change.message == '\0' ? Expect::Valid : Expect::Warn, change.message);
        ASSERT_TRUE(answer.model);
        const tinygltf::Model& model = answer.model.value();
        std::size_t left = 0;
        for (const tinygltf::Light& light : model.lights)
            left += light.type.empty() ? 0 : 1;
        for (const tinygltf::Camera& camera : model.cameras)
            left += camera.type.empty() ? 0 : 1;
        const std::string text = answer.text();
        const bool isLeftOut = text.find("the light is left out") != std::string::npos ||
                               text.find("the camera is left out") != std::string::npos;
        EXPECT_EQ(left, model.lights.empty() ? 2u : isLeftOut ? 4u : 5u);
    }
}

TEST(ViewRulesTest, theModelHasTheirNumbers)
{
    const LoadedDocument answer = load(document().dump());
    expectAnswer(answer, Expect::Valid, "");
    const tinygltf::Model& model = answer.model.value();
    ASSERT_EQ(model.lights.size(), 3u);
    EXPECT_EQ(model.lights[0].color, std::vector<double>({1.0, 0.5, 0.25}));
    EXPECT_EQ(model.lights[0].intensity, 3.0);
    EXPECT_EQ(model.lights[1].color, std::vector<double>({1.0, 1.0, 1.0}));
    EXPECT_EQ(model.lights[1].range, 9.0);
    EXPECT_EQ(model.lights[2].name, "lamp");
    EXPECT_EQ(model.lights[2].spot.outerConeAngle, 0.5);
    ASSERT_EQ(model.cameras.size(), 2u);
    EXPECT_EQ(model.cameras[0].perspective.yfov, 0.7);
    EXPECT_EQ(model.cameras[1].orthographic.ymag, 2.0);
    EXPECT_EQ(model.nodes[1].camera, 1);
    EXPECT_TRUE(answer.messages.notes.empty()) << answer.messages.notes.front();
}

} // namespace osgGpuAnimation::gltf
