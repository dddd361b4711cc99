// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/ModelBuilder.h"
#include "plugin/SharedAssets.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A clip of one second with these extras, through the whole import.
Result<ImportedModel> importWithExtras(const std::string& extras)
{
    ModelBuilder file;
    file.node("arm");
    file.animation("slide");
    file.slide(0);
    nlohmann::json document = nlohmann::json::parse(file.text());
    document["animations"][0]["extras"] = nlohmann::json::parse(extras);
    return importModel(document.dump(), "", {});
}

TEST(MarkersTest, ComeFromTheExtrasInOrderOfTime)
{
    const Result<ImportedModel> model = importWithExtras(
        R"({"markers":[{"time":0.75,"name":"right"},{"time":0.25,"name":"left","more":1},{"time":9,"name":"end"}]})");
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_TRUE(model.value().messages.warnings.empty());
    const std::vector<ClipMarker>& markers = model.value().set->clips()[0].markers();
    ASSERT_EQ(markers.size(), 3u);
    EXPECT_EQ(markers[0].name, "left");
    EXPECT_EQ(markers[0].time, 0.25);
    EXPECT_EQ(markers[1].name, "right");
    EXPECT_EQ(markers[2].time, 1.0) << "beyond the end: at the end";
}

TEST(MarkersTest, AFaultCostsTheMarkerWithAWarning)
{
    const std::pair<const char*, const char*> faults[] = {
        {R"({"markers":[{"time":-1,"name":"a"},{"time":0.5,"name":"good"}]})", "markers[0]: a time below 0"},
        {R"({"markers":[{"time":0.5,"name":"good"},{"time":"x","name":"a"}]})", "markers[1]: no number as its time"},
        {R"({"markers":[{"name":"a"},{"time":0.5,"name":"good"}]})", "no number as its time"},
        {R"({"markers":[{"time":0.5},{"time":0.5,"name":"good"}]})", "no text as its name"},
        {R"({"markers":[{"time":0.5,"name":7},{"time":0.5,"name":"good"}]})", "no text as its name"},
        {R"({"markers":[3,{"time":0.5,"name":"good"}]})", "markers[0]: no object"},
        {R"({"markers":[null,{"time":0.5,"name":"good"}]})", "markers[0]: no object"},
        {R"({"markers":[{"time":null,"name":"a"},{"time":0.5,"name":"good"}]})", "no number as its time"},
    };
    for (const auto& [extras, message] : faults)
    {
        SCOPED_TRACE(extras);
        const Result<ImportedModel> model = importWithExtras(extras);
        ASSERT_TRUE(model) << model.error().message;
        ASSERT_EQ(model.value().set->clips().size(), 1u);
        const std::vector<ClipMarker>& markers = model.value().set->clips()[0].markers();
        ASSERT_EQ(markers.size(), 1u);
        EXPECT_EQ(markers[0].name, "good");
        ASSERT_FALSE(model.value().messages.warnings.empty());
        const std::string& warning = model.value().messages.warnings.back();
        EXPECT_NE(warning.find("animations[0] \"slide\".extras."), std::string::npos) << warning;
        EXPECT_NE(warning.find(message), std::string::npos) << warning;
    }
}

TEST(MarkersTest, OtherExtrasAreNobodysBusiness)
{
    for (const char* extras : {"{}", "7", "[]", R"("markers")", R"({"marker":[1]})", R"({"markers":[]})"})
    {
        const Result<ImportedModel> model = importWithExtras(extras);
        ASSERT_TRUE(model) << extras;
        EXPECT_TRUE(model.value().messages.warnings.empty()) << extras;
        EXPECT_TRUE(model.value().set->clips()[0].markers().empty()) << extras;
    }
    const Result<ImportedModel> model = importWithExtras(R"({"markers":"none"})");
    ASSERT_TRUE(model);
    ASSERT_EQ(model.value().messages.warnings.size(), 1u);
    EXPECT_NE(model.value().messages.warnings[0].find("extras.markers: no array"), std::string::npos);
}

TEST(MarkersTest, TheWanderersFeetAreMarked)
{
    const std::string file = ownScene("Wanderer.glb");
    const Result<ImportedModel> model = importModel(readBytes(file), file, {});
    ASSERT_TRUE(model) << model.error().message;
    const AnimationSet& set = *model.value().set;
    const std::vector<ClipMarker>& markers = set.clips()[set.clipNamed("Run").value()].markers();
    ASSERT_EQ(markers.size(), 2u);
    EXPECT_EQ(markers[0].name, "left foot");
    EXPECT_EQ(markers[1].name, "right foot");
    EXPECT_NEAR(markers[1].time, 0.3, 1e-6);
}

} // namespace

} // namespace osgGpuAnimation::gltf
