// SPDX-License-Identifier: MIT
#include "assimp/ConversionProcess.h"
#include "assimp/AssimpFile.h"
#include "assimp/SmallFbx.h"
#include "support/Results.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

class ConversionProcessTest : public ::testing::Test
{
protected:
    /// A helper that is a shell script.
    assimp::ConversionHelper script(const std::string& commands)
    {
        assimp::ConversionHelper helper;
        helper.program = folder.write("helper", "#!/bin/sh\n" + commands + "\n");
        std::filesystem::permissions(helper.program, std::filesystem::perms::owner_all);
        return helper;
    }

    Result<std::string> read(const assimp::ConversionHelper& helper, const gltf::ImportOptions& options = {})
    {
        gltf::Report report(messages);
        return assimp::readAsGlbWith(helper, file, options, report);
    }

    ScratchFolder folder;
    std::string file = folder.write("box.fbx", SmallFbx().model(1, "box").box(2, 1).text());
    gltf::Messages messages;
};

TEST_F(ConversionProcessTest, theHelperGivesWhatTheConversionInThisProcessGives)
{
    SmallFbx blinking;
    blinking.model(1, "lamp").box(2, 1).take(10, "Blink", 0, 1);
    blinking.curve(10, 1, "Visibility", "Visibility", {{0, 1}, {1, 0}});
    file = folder.write("lamp.fbx", blinking.text());
    const std::string apart = valueOf(read(assimp::ConversionHelper::installed()));
    gltf::Messages here;
    gltf::Report report(here);
    EXPECT_EQ(apart, valueOf(assimp::readAsGlb(file, {}, report)));
    EXPECT_EQ(messages.warnings, here.warnings);
    EXPECT_EQ(messages.notes, here.notes);
    EXPECT_EQ(messages.warnings.size(), 1u);
}

TEST_F(ConversionProcessTest, optionsReachTheHelper)
{
    gltf::ImportOptions options;
    options.maxDecodedBytes = 100;
    const Result<std::string> tooLarge = read(assimp::ConversionHelper::installed(), options);
    ASSERT_FALSE(tooLarge);
    EXPECT_EQ(tooLarge.error().message, "the scene has more than 100 bytes of vertices and keys");
    options = {};
    options.maxNodeDepth = 1;
    const Result<std::string> tooDeep = read(assimp::ConversionHelper::installed(), options);
    ASSERT_FALSE(tooDeep);
    EXPECT_EQ(tooDeep.error().message, "the hierarchy of nodes is deeper than 1");
}

TEST_F(ConversionProcessTest, whatEndsTheHelperIsAnErrorWithASentence)
{
    const struct
    {
        const char *commands, *says;
    } cases[] = {
        {"kill -ABRT $$", "Assimp ended with signal 6 (Aborted) while it read the file; the file is damaged"},
        {"echo 'first' >&2; echo 'assert: !keys.empty()' >&2; kill -SEGV $$",
         "Assimp ended with signal 11 (Segmentation fault) while it read the file: assert: !keys.empty(); the file"},
        {"exit 3", "of memory"},
        {"exit 0", "ended without a result"},
        {"echo 'cannot load libassimp.so' >&2; exit 127", "ended without a result: cannot load libassimp.so"},
        {R"(printf '{"warnings":[],"notes":[],"bytes":65535}\nglTF')", "ended without a result"},
        {R"(printf '{"warnings":1,"notes":[],"bytes":4}\nglTF')", "ended without a result"},
        {R"(printf '{"warnings":[],"notes":[],"error":{}}\n')", "ended without a result"},
        {"printf 'x\\0\\0\\0\\n'", "ended without a result"},
        {"head -c 100000 /dev/zero >&2; kill -ABRT $$", "Assimp ended with signal 6"},
    };
    for (const auto& each : cases)
    {
        const Result<std::string> result = read(script(each.commands));
        ASSERT_FALSE(result) << each.commands;
        EXPECT_NE(result.error().message.find(each.says), std::string::npos) << result.error().message;
    }
}

TEST_F(ConversionProcessTest, timeAndOutputAreLimited)
{
    const auto start = std::chrono::steady_clock::now();
    assimp::ConversionHelper slow = script("exec sleep 100");
    slow.seconds = 0.2;
    const Result<std::string> late = read(slow);
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().message, "Assimp was stopped: it had not read the file after 0.2 seconds");
    assimp::ConversionHelper silent = script("exec >&- 2>&-; exec sleep 100"); // it closes the pipes and goes on
    silent.seconds = 0.2;
    EXPECT_FALSE(read(silent));
    assimp::ConversionHelper large = script("exec cat /dev/zero");
    large.maxOutputBytes = 1 << 20;
    const Result<std::string> tooLarge = read(large);
    ASSERT_FALSE(tooLarge);
    EXPECT_EQ(tooLarge.error().message, "Assimp was stopped: it made more than 1 MiB of the file");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST_F(ConversionProcessTest, memoryIsLimited)
{
    assimp::ConversionHelper helper = assimp::ConversionHelper::installed();
    helper.memoryBytes = std::size_t(700) << 20; // what the libraries need of addresses, and no more
    file = folder.write("large.fbx", SmallFbx().model(1, "box").box(2, 1).text());
    {
        std::ofstream more(file, std::ios::app);
        more << "Objects2: {\n";
        for (int i = 0; i < 4000000; ++i)
            more << "A:1\n";
        more << "}\n";
    }
    const Result<std::string> result = read(helper);
    ASSERT_EQ(static_cast<bool>(result), assimp::reservesAddressSpace);
    if (result) return;
    EXPECT_NE(result.error().message.find("MiB of memory"), std::string::npos) << result.error().message;
}

TEST_F(ConversionProcessTest, withoutTheHelperAnErrorNamesIt)
{
    const Result<std::string> missing = read(assimp::ConversionHelper());
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().message, "the program osggpuanim_assimp, which converts the files that Assimp reads, is "
                                       "missing: install it beside osgdb_assimp.so");
    assimp::ConversionHelper removed;
    removed.program = folder.file("removed");
    const Result<std::string> result = read(removed);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("cannot be started: No such file or directory"), std::string::npos)
        << result.error().message;
}

TEST_F(ConversionProcessTest, damagedFilesAreErrorsAndNoCrash)
{
    // Assimp 5.2 ends the process for each of them.
    const struct
    {
        const char *name, *content;
    } files[] = {
        {"empty.x", "xof 0303txt 0032\nMesh {\n4294967295;\n"},
        {"cut.md5mesh", "MD5Version 10\nnumJoints 1\nnumMeshes 1\njoints {\n\"a\" 5 ( 0 0 0 ) ( 0 0 0 )\n}\nmesh {\n"
                        "numverts 1\nvert 0 ( 0 0 ) 9 9\nnumtris 1\ntri 0 7 8 9\nnumweights 0\n}\n"},
    };
    for (const auto& each : files)
    {
        file = folder.write(each.name, each.content);
        const Result<std::string> result = read(assimp::ConversionHelper::installed());
        EXPECT_FALSE(result) << each.name;
    }
}

} // namespace

} // namespace osgGpuAnimation
