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

/// The decoded text, or "error: " and the message.
std::string decoded(const std::string& uri, std::size_t most = 1000)
{
    const Result<DataUri> data = decodeDataUri(uri, most);
    if (!data) return "error: " + data.error().message;
    return std::string(data.value().bytes.begin(), data.value().bytes.end());
}

std::string path(const std::string& uri)
{
    const Result<std::string> found = decodePath(uri);
    return found ? found.value() : "error: " + found.error().message;
}

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
        scratch.write("model/rübe.bin", "accented");
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

TEST(UriTest, decodesDataOfAnyTypeAndTellsItsBytesBefore)
{
    const std::pair<const char*, const char*> cases[] = {{"data:application/octet-stream;base64,Zm94", "fox"},
                                                         {"data:image/x-unknown;base64,Zm94ZXM=", "foxes"},
                                                         {"data:;base64,Zm94ZXM", "foxes"}, // padding may be missing
                                                         {"data:text/plain;charset=utf-8;base64,Zg==", "f"},
                                                         {"DATA:text/plain;BASE64,Zm8=", "fo"},
                                                         {"data:;base64,", ""},
                                                         {"data:,a%20b+c", "a b+c"},
                                                         {"data:,%41%42%43", "ABC"},
                                                         {"data:,", ""}};
    for (const auto& [uri, text] : cases)
    {
        EXPECT_EQ(decoded(uri), text) << uri;
        EXPECT_EQ(bytesOfDataUri(uri).value(), std::string(text).size()) << uri;
    }
    EXPECT_EQ(decodeDataUri("data:image/png;x=1;base64,Zg==", 9).value().mimeType, "image/png");
    EXPECT_FALSE(bytesOfDataUri("data:"));
    EXPECT_EQ(bytesOfDataUri("data:,%%%%").value(), 2u); // invalid escapes do not make the size negative
}

TEST(UriTest, refusesFaultyDataAlsoBeyondTheBytesThatItKeeps)
{
    for (const char* uri : {"data:", "data:text/plain;base64", "data:;base64,Zm9!", "data:;base64,Zm94Z", "data:,%4",
                            "data:;base64,Zm=4", "data:;base64,Zm 94"})
        EXPECT_EQ(decoded(uri).substr(0, 6), "error:") << uri;
    EXPECT_EQ(decoded("data:;base64,Zm94ZXM=", 3), "fox");
    EXPECT_EQ(decoded("data:,a%20b+c", 2), "a ");
    EXPECT_EQ(decoded("data:;base64,Zm94Z!", 3).substr(0, 6), "error:");
    EXPECT_EQ(decoded("data:,fox%4", 3).substr(0, 6), "error:");
}

TEST(UriTest, resolvesRelativePaths)
{
    EXPECT_EQ(path("a%20b/c+d.bin"), "a b/c+d.bin");
    EXPECT_EQ(path("r%C3%BCbe.png"), "rübe.png");
    EXPECT_EQ(path("rübe.png"), "rübe.png");
    EXPECT_EQ(path("a%2Fb"), "a/b");
    EXPECT_EQ(path("12:3.bin"), "12:3.bin"); // a scheme begins with a letter
    for (const char* uri : {"", "http://host/x.png", "file:///etc/passwd", "C:/x.bin", "x+y.z-1:rest", "a%", "a%4",
                            "a%zz", "a%00b", "..\\a", "a%5Cb"})
        EXPECT_EQ(path(uri).substr(0, 6), "error:") << uri;
}

TEST_F(ModelFolderTest, readsInTheFolderAndBelow)
{
    for (const char* uri : {"in.bin", "./in.bin", "deep/../in.bin", "link-in.bin"})
        EXPECT_EQ(read(uri), "inside") << uri;
    EXPECT_EQ(read("deep/below.bin"), "below");
    EXPECT_EQ(read("a%20b+c.bin"), "spaced");
    EXPECT_EQ(read("r%C3%BCbe.bin"), "accented");
    EXPECT_EQ(read("in.bin", false, "link-to-model/model.gltf"), "inside");
}

TEST_F(ModelFolderTest, staysInsideUnlessAllowed)
{
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("deep/../../outside.bin"), std::string("%2e%2e/outside.bin"),
          std::string("link-out.bin"), std::string("link-up/outside.bin"), std::string("link-beside.bin"),
          std::string("../models/beside.bin"), scratch.file("outside.bin")})
    {
        EXPECT_NE(read(uri).find("allowOutsideFiles"), std::string::npos) << uri << ": " << read(uri);
        EXPECT_EQ(read(uri, true), "outside") << uri;
    }
    EXPECT_NE(read("../no-such-file").find("allowOutsideFiles"), std::string::npos) << "whether it exists is not said";
}

TEST_F(ModelFolderTest, readsRegularFilesOtherThanTheModelOnly)
{
    const std::tuple<std::string, bool, const char*> faults[] = {
        {".", false, "folder"},
        {"deep", false, "folder"},
        {"pipe", false, "pipe"},
        {"link-zero", true, "device"},
        {"/dev/zero", true, "device"},
        {"round", false, "error:"},
        {"none.bin", false, "does not exist"},
        {"in.bin/x", false, "does not exist"},
        {std::string(100000, 'x'), false, "error:"},
        {"model.gltf", false, "model file itself"},
        {"deep/../model.gltf", true, "model file itself"},
    };
    for (const auto& [uri, allowOutside, message] : faults)
        EXPECT_NE(read(uri, allowOutside).find(message), std::string::npos) << uri << ": " << read(uri, allowOutside);
    const Result<RegularFile> file = ModelFolder("", true).open("in.bin");
    ASSERT_FALSE(file);
    EXPECT_NE(file.error().message.find("without a file name"), std::string::npos);
}

} // namespace osgGpuAnimation::gltf
