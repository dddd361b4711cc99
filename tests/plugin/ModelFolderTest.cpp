// SPDX-License-Identifier: MIT
#include "gltf/file/Uri.h"

#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <sys/stat.h>

namespace osgGpuAnimation::gltf
{

namespace
{

namespace fs = std::filesystem;

/// outside.bin, and a folder `model` with model.gltf, in.bin, deep/below.bin, a pipe and several kinds of links.
class ModelFolderTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        fs::create_directories(scratch.file("model/deep"));
        fs::create_directories(scratch.file("models")); // its name begins with the model's folder's
        scratch.write("outside.bin", "outside");
        scratch.write("models/beside.bin", "outside");
        scratch.write("model/model.gltf", "{}");
        scratch.write("model/in.bin", "inside");
        scratch.write("model/a b+c.bin", "spaced");
        scratch.write("model/r\xc3\xbc"
                      "be.bin",
                      "accented");
        scratch.write("model/deep/below.bin", "below");
        ASSERT_EQ(mkfifo(scratch.file("model/pipe").c_str(), 0600), 0);
        fs::create_symlink("../outside.bin", scratch.file("model/link-out.bin"));
        fs::create_symlink("../models/beside.bin", scratch.file("model/link-beside.bin"));
        fs::create_symlink("in.bin", scratch.file("model/link-in.bin"));
        fs::create_symlink("..", scratch.file("model/link-up"));
        fs::create_symlink("/dev/zero", scratch.file("model/link-zero"));
        fs::create_symlink("round", scratch.file("model/round"));
        fs::create_symlink("model", scratch.file("link-to-model"));
    }

    /// The content, or "error: " and the message.
    std::string read(const std::string& uri, bool allowOutside = false, const std::string& model = "model/model.gltf")
    {
        const Result<RegularFile> file = ModelFolder(scratch.file(model), allowOutside).open(uri);
        if (!file) return "error: " + file.error().message;
        std::string content(file.value().size(), '\0');
        const Result<std::size_t> done = file.value().read(content.data(), content.size());
        return done ? content : "error: " + done.error().message;
    }

    ScratchFolder scratch;
};

} // namespace

TEST_F(ModelFolderTest, ReadsInTheFolderAndBelow)
{
    EXPECT_EQ(read("in.bin"), "inside");
    EXPECT_EQ(read("./in.bin"), "inside");
    EXPECT_EQ(read("deep/below.bin"), "below");
    EXPECT_EQ(read("deep/../in.bin"), "inside");
    EXPECT_EQ(read("link-in.bin"), "inside");
    EXPECT_EQ(read("a%20b+c.bin"), "spaced");
    EXPECT_EQ(read("a b+c.bin"), "spaced");
    EXPECT_EQ(read("r%C3%BCbe.bin"), "accented");
    EXPECT_EQ(read("r\xc3\xbc"
                   "be.bin"),
              "accented");
    EXPECT_EQ(read("in.bin", false, "link-to-model/model.gltf"), "inside");
}

TEST_F(ModelFolderTest, StaysInsideUnlessAllowed)
{
    const std::string absolute = scratch.file("outside.bin");
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("deep/../../outside.bin"), std::string("%2e%2e/outside.bin"),
          std::string("link-out.bin"), std::string("link-up/outside.bin"), std::string("link-beside.bin"),
          std::string("../models/beside.bin"), absolute})
    {
        SCOPED_TRACE(uri);
        EXPECT_NE(read(uri).find("allowOutsideFiles"), std::string::npos) << read(uri);
        EXPECT_EQ(read(uri, true), "outside");
    }
}

TEST_F(ModelFolderTest, DoesNotTellWhetherAFileOutsideExists)
{
    EXPECT_NE(read("../no-such-file").find("allowOutsideFiles"), std::string::npos);
}

TEST_F(ModelFolderTest, RegularFilesOnly)
{
    EXPECT_NE(read(".").find("folder"), std::string::npos);
    EXPECT_NE(read("deep").find("folder"), std::string::npos);
    EXPECT_NE(read("pipe").find("pipe"), std::string::npos);
    EXPECT_NE(read("link-zero", true).find("device"), std::string::npos);
    EXPECT_NE(read("/dev/zero", true).find("device"), std::string::npos);
    EXPECT_EQ(read("round").substr(0, 6), "error:");
    EXPECT_NE(read("none.bin").find("does not exist"), std::string::npos);
    EXPECT_NE(read("in.bin/x").find("does not exist"), std::string::npos);
    EXPECT_EQ(read(std::string(100000, 'x')).substr(0, 6), "error:");
}

TEST_F(ModelFolderTest, TheModelIsNoFileOfItsOwn)
{
    EXPECT_NE(read("model.gltf").find("model file itself"), std::string::npos);
    EXPECT_NE(read("deep/../model.gltf", true).find("model file itself"), std::string::npos);
}

TEST_F(ModelFolderTest, AStreamHasNoFiles)
{
    const Result<RegularFile> file = ModelFolder("", true).open("in.bin");
    ASSERT_FALSE(file);
    EXPECT_NE(file.error().message.find("without a file name"), std::string::npos);
}

TEST_F(ModelFolderTest, WholeFilesSayWhatIsWrong)
{
    scratch.write("empty.glb", "");
    fs::resize_file(scratch.write("holes.glb", "glTF"), (std::uintmax_t(1) << 32) + 1); // a sparse file
    EXPECT_EQ(readModelFile(scratch.file("outside.bin"), {}).value(), "outside");
    const std::pair<const char*, const char*> faults[] = {{"none.glb", "does not exist"},
                                                          {"model", "a folder"},
                                                          {"empty.glb", "is empty"},
                                                          {"holes.glb", "at most 4294967296 bytes, found 4294967297"},
                                                          {"model/pipe", "a pipe"}};
    for (const auto& [name, message] : faults)
    {
        const Result<std::string> content = readModelFile(scratch.file(name), {});
        ASSERT_FALSE(content) << name;
        EXPECT_NE(content.error().message.find(message), std::string::npos) << content.error().message;
    }
}

} // namespace osgGpuAnimation::gltf
