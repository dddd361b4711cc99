// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "gltf/file/Uri.h"
#include "gltf/GlbText.h"
#include "gltf/Import.h"
#include "support/PeakMemory.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <streambuf>
#include <string>
#include <tuple>

#include <sys/stat.h>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t limit = 1000;

/// A JSON document of that many bytes.
std::string json(std::size_t bytes)
{
    const std::string text = R"({"asset":{"version":"2.0"}})";
    return text + std::string(bytes - text.size(), ' ');
}

/// A stream that starts with the text and continues with spaces forever.
class EndlessStream : public std::streambuf
{
public:
    explicit EndlessStream(std::string beginning) { give(std::move(beginning)); }
    std::size_t given = 0; ///< bytes

protected:
    int_type underflow() override { return give(std::string(4096, ' ')); }

private:
    int_type give(std::string block)
    {
        _block = std::move(block);
        given += _block.size();
        setg(_block.data(), _block.data(), _block.data() + _block.size());
        return traits_type::to_int_type(_block[0]);
    }

    std::string _block;
};

struct ModelBytesTest : ::testing::Test
{
    /// Reads and imports the content, from a file or a stream: the error's message, empty if there is none.
    std::string read(const std::string& content, bool isFile)
    {
        std::istringstream stream(content);
        const Result<std::string> bytes =
            isFile ? readModelFile(scratch.write("model", content), options) : readModelStream(stream, options);
        if (!bytes) return bytes.error().message;
        EXPECT_EQ(bytes.value(), content);
        const Result<ImportedModel> model = importModel(bytes.value(), "", options);
        return model ? "" : model.error().message;
    }

    ScratchFolder scratch;
    ImportOptions options;
};

struct ContainerCase
{
    const char* name;
    std::string bytes;
    const char* message; ///< part of the error, or of the only warning; empty: neither
    bool isRefused;
};

const std::string small = R"({"a":1} )";
const GlbChunk text{jsonChunk, small}, data{binaryChunk, "abcd"}, unknown{0x41414141, "wxyz"};

const ContainerCase containers[] = {
    {"version 1", glb({text}, 1), "version 2", true},
    {"cut in the JSON chunk", glb({text}).substr(0, 24), "truncated", true},
    {"BIN first", glb({data, text}), "the JSON chunk, found the BIN chunk", true},
    {"an unknown chunk first", glb({unknown, text}), "found type 1094795585", true},
    {"a chunk longer than the file", glb({text}, 2, 100), "length of at most", true},
    {"half a chunk header at the end", glb({text}, 2, 0, "abcd"), "a header of 8 bytes", true},
    {"an empty BIN chunk", glb({text, {binaryChunk, ""}}), "", false},
    {"an unknown chunk after BIN", glb({text, data, unknown}), "", false},
    {"two JSON chunks", glb({text, data, text}), "second JSON", false},
    {"data after the end", glb({text, data}) + "tail", "4 bytes after", false},
    {"an odd chunk", glb({text, {binaryChunk, "abc"}}), "multiple of 4", false},
};

} // namespace

TEST(GlbContainerTest, answersEachFile)
{
    for (const ContainerCase& file : containers)
    {
        SCOPED_TRACE(file.name);
        Messages messages;
        Report report(messages);
        const Result<GlbContainer> container = splitContainer(file.bytes, report);
        ASSERT_EQ(!container, file.isRefused);
        EXPECT_EQ(messages.warnings.size(), !file.isRefused && *file.message ? 1u : 0u);
        const std::string message = file.isRefused              ? container.error().message
                                    : messages.warnings.empty() ? ""
                                                                : messages.warnings[0];
        EXPECT_NE(message.find(file.message), std::string::npos) << message;
        if (file.isRefused) continue;
        EXPECT_EQ(container.value().json, small);
        EXPECT_TRUE(container.value().binary);
    }
}

TEST(GlbContainerTest, anUnknownChunkIsNotBinAndOtherBytesAreJson)
{
    Messages messages;
    Report report(messages);
    EXPECT_FALSE(splitContainer(glb({text, unknown}), report).value().binary);
    EXPECT_EQ(splitContainer("GLTF and so on", report).value().json, "GLTF and so on");
}

TEST_F(ModelBytesTest, jsonKeepsToItsLimit)
{
    options.maxJsonBytes = limit;
    const std::string message = "JSON: expected a text of at most 1000 bytes (limit maxJsonBytes), found ";
    const GlbChunk zeros{binaryChunk, std::string(100000, '\0')};
    const std::pair<std::string, std::string> cases[] = {
        {json(limit), ""},
        {json(limit + 4), message + "1004"},
        {json(300000), message},
        {glb({{jsonChunk, json(limit)}, zeros}), ""},
        {glb({{jsonChunk, json(limit + 4)}, zeros}), message},
        {glb({{jsonChunk, json(300000)}}), message},
        {glb({{jsonChunk, json(limit)}}, 2, 1u << 30), "GLB chunk 0: expected a length of at most"},
        {"", "empty"},
        {"glTF", "GLB header: expected 12 bytes"},
    };
    for (const auto& [content, expected] : cases)
        for (const bool isFile : {true, false})
        {
            const std::string found = read(content, isFile);
            EXPECT_TRUE(expected.empty() ? found.empty() : found.find(expected) != std::string::npos)
                << content.substr(0, 4) << " of " << content.size() << ": " << found;
        }
}

TEST_F(ModelBytesTest, aStreamMayHaveNoEnd)
{
    const std::string glbBeginning = glb({{jsonChunk, json(100)}, {binaryChunk, ""}}, 2, 0xffffffff);
    const std::tuple<std::string, std::size_t, std::string> cases[] = {
        {"{", std::size_t(2) << 30, "JSON: expected a text of at most 1000 bytes (limit maxJsonBytes), found "},
        {glbBeginning, 1000000, "the stream holds more than 1000000 bytes, or does not end"},
    };
    options.maxJsonBytes = limit;
    for (const auto& [beginning, maxBytes, expected] : cases)
    {
        SCOPED_TRACE(expected);
        EndlessStream endless(beginning);
        std::istream stream(&endless);
        const Result<std::string> bytes = readModelStream(stream, options, maxBytes);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().message.substr(0, expected.size()), expected);
        EXPECT_LT(endless.given, 1200000u); // little more is read than the limit allows
    }
    const std::string content = glb({{jsonChunk, json(100)}, {binaryChunk, std::string(200000, 'a')}});
    for (const std::size_t maxBytes : {content.size(), content.size() - 1})
    {
        std::istringstream stream(content);
        EXPECT_EQ(bool(readModelStream(stream, options, maxBytes)), maxBytes == content.size());
    }
}

TEST_F(ModelBytesTest, wholeFilesSayWhatIsWrong)
{
    scratch.write("good.glb", "content");
    scratch.write("empty.glb", "");
    namespace fs = std::filesystem;
    fs::resize_file(scratch.write("holes.glb", "glTF"), (std::uintmax_t(1) << 32) + 1); // sparse files
    fs::resize_file(scratch.write("holes.gltf", "{"), std::uintmax_t(3) << 30);
    EXPECT_EQ(readModelFile(scratch.file("good.glb"), {}).value(), "content");
    const std::string longName(250, 'x');
    const std::pair<std::string, const char*> faults[] = {
        {longName, "the file does not exist"}, // and not the path
        {"", "a folder"},
        {"empty.glb", "is empty"},
        {"holes.glb", "at most 4294967296 bytes, found 4294967297"},
        {"holes.gltf", "JSON: expected a text of at most 536870912 bytes (limit maxJsonBytes), found 3221225472"}};
    const long before = peakMemory();
    for (const auto& [name, message] : faults)
    {
        const Result<std::string> content = readModelFile(scratch.file(name), options);
        ASSERT_FALSE(content) << name;
        EXPECT_NE(content.error().message.find(message), std::string::npos) << content.error().message;
        EXPECT_EQ(content.error().message.find(longName), std::string::npos);
    }
    if (memoryIsMeasurable)
    {
        EXPECT_LT(peakMemory() - before, 10) << "refused before it is read";
    }
}

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
