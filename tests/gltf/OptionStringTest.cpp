// SPDX-License-Identifier: MIT
#include "gltf/file/ImportOptions.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <string>
#include <tuple>

namespace osgGpuAnimation::gltf
{

TEST(OptionStringTest, readsAllOptions)
{
    const ImportOptions options =
        parseOptions("  clip=Walk scene=2  noRotation allowOutsideFiles maxJsonDepth=5 maxJsonBytes=4 maxNodeDepth=6 "
                     "maxElements=7 maxDocumentBytes=8 maxDecodedBytes=8000000000 camera=Top noLights noCameras "
                     "variant=1 clips=Run.glb clips=\"Walk fast.glb\" clipJoints=names.json speed=-1.5 start=0.25 "
                     "loop=pingpong fade=0 noKeys pixelError=0.5 compact=1e-4 clipMatch=byName wholeModel")
            .value();
    EXPECT_EQ(options.clip, "Walk");
    EXPECT_EQ(options.clipsFiles, (std::vector<std::string>{"Run.glb", "Walk fast.glb"}));
    EXPECT_EQ(options.clipJoints, "names.json");
    EXPECT_EQ(options.clipMatch, ClipMatch::ByName);
    EXPECT_EQ(options.scene, 2);
    EXPECT_EQ(options.camera, "Top");
    EXPECT_EQ(options.variant, "1");
    EXPECT_EQ(options.maxJsonBytes, 4u);
    EXPECT_EQ(options.maxJsonDepth, 5u);
    EXPECT_EQ(options.maxNodeDepth, 6u);
    EXPECT_EQ(options.maxElements, 7u);
    EXPECT_EQ(options.maxDocumentBytes, 8u);
    EXPECT_EQ(options.maxDecodedBytes, 8000000000u);
    EXPECT_EQ(options.speed, -1.5);
    EXPECT_EQ(options.start, 0.25);
    EXPECT_EQ(options.loopMode, LoopMode::PingPong);
    EXPECT_EQ(options.fadeSeconds, 0.0);
    EXPECT_EQ(options.pixelError, 0.5);
    EXPECT_EQ(options.compact, 1e-4);
    // Words are apart: other readers' words are passed over.
    const ImportOptions none = parseOptions("dds_flip OutputTextureFiles = \"\" noRotationX").value();
    EXPECT_FALSE(none.clip || none.scene || none.camera || none.variant || none.compact || none.start);
    EXPECT_EQ(none.clipMatch, ClipMatch::Automatic);
    EXPECT_EQ(none.speed, 1.0);
    EXPECT_EQ(none.loopMode, LoopMode::Loop);
    EXPECT_EQ(none.pixelError, 0.0);
    for (const bool ImportOptions::*flag :
         {&ImportOptions::noRotation, &ImportOptions::allowOutsideFiles, &ImportOptions::noLights,
          &ImportOptions::noCameras, &ImportOptions::noKeys, &ImportOptions::wholeModel})
    {
        EXPECT_TRUE(options.*flag);
        EXPECT_FALSE(none.*flag);
    }
    EXPECT_EQ(parseOptions("loop=once").value().loopMode, LoopMode::Once);
    EXPECT_EQ(parseOptions("clipMatch=retarget").value().clipMatch, ClipMatch::Retarget);
    EXPECT_EQ(parseOptions("clipMatch=auto").value().clipMatch, ClipMatch::Automatic);
    EXPECT_EQ(parseOptions("loop=loop").value().loopMode, LoopMode::Loop);
    EXPECT_EQ(parseOptions("compact=1").value().compact, 1.0);
    EXPECT_TRUE(parseOptions("start=0"));
}

TEST(OptionStringTest, limitsAreByDefaultWhatTheHelpSays)
{
    const ImportOptions options = parseOptions("").value();
    constexpr std::size_t mebibyte = std::size_t(1) << 20;
    const std::tuple<std::string, std::size_t, std::string> limits[] = {
        {"maxJsonBytes=N", options.maxJsonBytes / mebibyte, " MiB"},
        {"maxJsonDepth=N", options.maxJsonDepth, ""},
        {"maxNodeDepth=N", options.maxNodeDepth, ""},
        {"maxElements=N", options.maxElements, ""},
        {"maxDocumentBytes=N", options.maxDocumentBytes / mebibyte, " MiB"},
        {"maxDecodedBytes=N", options.maxDecodedBytes / mebibyte / 1024, " GiB"},
    };
    std::size_t found = 0;
    for (const auto& [usage, help] : optionHelp())
        for (const auto& [name, value, unit] : limits)
        {
            if (usage != name) continue;
            ++found;
            const std::string text = help;
            EXPECT_EQ(text.substr(text.rfind(": ") + 2), std::to_string(value) + unit) << usage;
        }
    EXPECT_EQ(found, std::size(limits));
    EXPECT_EQ(options.maxJsonBytes % mebibyte + options.maxDocumentBytes % mebibyte, 0u);
    EXPECT_EQ(options.maxDecodedBytes % (1024 * mebibyte), 0u);
}

TEST(OptionStringTest, quotationMarksKeepSpaces)
{
    const std::pair<const char*, const char*> clips[] = {
        {"clip=\"Walk fast\" noRotation", "Walk fast"},
        {"\"clip=Walk fast\"", "Walk fast"},
        {"clip=a=b", "a=b"},
        {"clip=\"a=b c\"", "a=b c"},
        {"clip=\"never closed", "never closed"},
    };
    for (const auto& [text, clip] : clips)
    {
        const Result<ImportOptions> options = parseOptions(text);
        ASSERT_TRUE(options) << text;
        EXPECT_EQ(options.value().clip.value_or("?"), clip) << text;
    }
}

TEST(OptionStringTest, errorsSayWhatIsWanted)
{
    const std::pair<const char*, const char*> cases[] = {
        {"clipMatch=name", "option clipMatch: \"name\" is not auto, byName or retarget"},
        {"loop=twice", "option loop: \"twice\" is not once, loop or pingpong"},
        {"speed=fast", "option speed: \"fast\" is not a number"},
        {"pixelError=-1", "option pixelError: \"-1\" is not a number of pixels from 0 to 1000000"},
        {"fade=-1", "option fade: \"-1\" is not a number of seconds, 0 or more"},
        {"scene=one", "option scene: \"one\" is not a whole number that is not too large"},
    };
    for (const auto& [text, message] : cases)
    {
        const Result<ImportOptions> options = parseOptions(text);
        ASSERT_FALSE(options) << text;
        EXPECT_EQ(options.error().message, message);
    }
    const std::pair<const char*, std::vector<const char*>> faults[] = {
        {"clip", {"", "="}},
        {"clips", {"="}},
        {"clipJoints", {"="}},
        {"scene", {"=", "=-1", "=1.5", "=99999999999"}},
        {"maxElements", {"=-1"}},
        {"maxDecodedBytes", {"=1e9"}},
        {"compact", {"", "=0", "=-1e-4", "=1.0000001", "=nan", "=inf"}},
        {"pixelError", {"", "=-0.5", "=nan", "=1e7", "=inf"}},
        {"speed", {"", "=", "=nan", "=inf", "=1x", "=1e999"}},
        {"start", {"=", "=-0.5", "=nan"}},
        {"randomStart", {"", "=-1", "=now"}},
        {"loop", {"=", "=Once"}},
        {"fade", {"=-0.1", "=inf", "=x"}},
    };
    for (const auto& [name, values] : faults)
        for (const char* value : values)
        {
            const Result<ImportOptions> options = parseOptions(name + std::string(value));
            ASSERT_FALSE(options) << name << value;
            EXPECT_EQ(options.error().message.rfind("option " + std::string(name), 0), 0u) << options.error().message;
        }
}

TEST(OptionStringTest, misspeltOptionsAreNamed)
{
    const std::pair<const char*, const char*> words[] = {
        {"clip=Run clips=Run.glb speed=2 noRotation maxElements=5", ""},
        {"spacing=2 noTriStripPolygons dds_flip noColors", ""}, // others'
        {"Clip=Run", "\"clip\""},
        {"norotation", "\"noRotation\""},
        {"spead=2", "\"speed\""},
        {"clipx=Run", "\"clip\""},
        {"cip=Run", "\"clip\""},
        {"sclae=2 spede=2", "\"speed\""},
    };
    for (const auto& [text, meant] : words)
    {
        SCOPED_TRACE(text);
        const std::vector<std::string> hints = misspeltOptions(text, optionHelp());
        ASSERT_EQ(hints.size(), *meant == '\0' ? 0u : 1u);
        EXPECT_TRUE(hints.empty() || hints.front().find(meant) != std::string::npos) << hints.front();
    }
}

} // namespace osgGpuAnimation::gltf
