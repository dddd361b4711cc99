// SPDX-License-Identifier: MIT
#include "support/ScratchFolder.h"

#include "gltf/file/SavedFile.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace osgGpuAnimation::gltf
{

namespace
{

namespace fs = std::filesystem;

std::string contentOf(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string messageOf(const Result<void>& result)
{
    return result ? "" : result.error().message;
}

/// Files cannot grow beyond these bytes while it exists, as on a disk that is full.
class FullDisk
{
public:
    explicit FullDisk(rlim_t bytes) : _signal(std::signal(SIGXFSZ, SIG_IGN))
    {
        getrlimit(RLIMIT_FSIZE, &_before);
        const rlimit full{bytes, _before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &full);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk()
    {
        setrlimit(RLIMIT_FSIZE, &_before);
        std::signal(SIGXFSZ, _signal);
    }

private:
    void (*_signal)(int);
    rlimit _before{};
};

/// Permissions do not bind root: while it exists, root is another user.
class BoundByPermissions
{
public:
    BoundByPermissions() : _isOther(geteuid() == 0 && seteuid(65534) == 0) {}
    BoundByPermissions(const BoundByPermissions&) = delete;
    BoundByPermissions& operator=(const BoundByPermissions&) = delete;
    ~BoundByPermissions()
    {
        if (_isOther && seteuid(0) != 0) std::abort();
    }

private:
    const bool _isOther;
};

TEST(SavedFileTest, aFileIsWrittenAsAWholeOrStaysAsItWas)
{
    const ScratchFolder folder;
    const std::string file = folder.file("a.glb");
    const std::string large(100000, 'x');
    EXPECT_EQ(messageOf(saveFile(file, "first")), "");
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(messageOf(saveFile(file, "second")), "");
    {
        const FullDisk full(4096);
        EXPECT_EQ(messageOf(saveFile(file, large)), "cannot be written: File too large");
        EXPECT_EQ(messageOf(saveFile(folder.file("new.glb"), large)), "cannot be written: File too large");
    }
    EXPECT_EQ(contentOf(file), "second");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.file("")), {}), 1) << "no other file is left";
    EXPECT_EQ(messageOf(saveFile(file, large)), "");
    EXPECT_EQ(contentOf(file), large);
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(messageOf(saveFile(folder.file("no/a.glb"), "")), "cannot be written: No such file or directory");
    EXPECT_EQ(messageOf(saveFile(folder.file(""), "")), "cannot be written: Is a directory");
}

TEST(SavedFileTest, linksAndDevicesStayWhatTheyAre)
{
    const ScratchFolder folder;
    const std::string file = folder.write("a.glb", "old"), link = folder.file("link.glb"),
                      none = folder.file("null.glb"), full = folder.file("full.glb");
    fs::create_symlink(file, link);
    fs::create_symlink("/dev/null", none);
    fs::create_symlink("/dev/full", full);
    EXPECT_EQ(messageOf(saveFile(link, "new")), "");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(contentOf(file), "new");
    EXPECT_EQ(messageOf(saveFile(none, "new")), "");
    EXPECT_EQ(messageOf(saveFile(full, "new")), "cannot be written: No space left on device");
    EXPECT_TRUE(fs::is_symlink(none) && fs::is_symlink(full));
    // Links to links, to a file that is missing, and to themselves.
    fs::create_directory(folder.file("below"));
    fs::create_symlink("below/second.glb", folder.file("first.glb"));
    fs::create_symlink("b.glb", folder.file("below/second.glb"));
    fs::create_symlink("loop.glb", folder.file("loop.glb"));
    EXPECT_EQ(messageOf(saveFile(folder.file("first.glb"), "new")), "");
    EXPECT_TRUE(fs::is_symlink(folder.file("first.glb")) && fs::is_symlink(folder.file("below/second.glb")));
    EXPECT_EQ(contentOf(folder.file("below/b.glb")), "new");
    EXPECT_EQ(messageOf(saveFile(folder.file("loop.glb"), "new")),
              "cannot be written: Too many levels of symbolic links");
}

// Process numbers repeat, in containers within minutes.
TEST(SavedFileTest, filesOfInterruptedProgramsAreNoObstacle)
{
    const ScratchFolder folder;
    const std::string process = "a.glb." + std::to_string(getpid());
    const std::string stale[] = {folder.write(process + ".part", "old"), folder.write(process + "-0.part", "old"),
                                 folder.write(process + "-1.part", "old")};
    EXPECT_EQ(messageOf(saveFile(folder.file("a.glb"), "new")), "");
    EXPECT_EQ(contentOf(folder.file("a.glb")), "new");
    for (const std::string& file : stale)
        EXPECT_EQ(contentOf(file), "old") << file;
}

TEST(SavedFileTest, aFileIsWrittenWhereNoOtherCanBeMade)
{
    const ScratchFolder folder;
    const std::string file = folder.write("a.glb", "old"), longest = folder.file(std::string(255, 'x'));
    EXPECT_EQ(messageOf(saveFile(longest, "new")), "");
    EXPECT_EQ(contentOf(longest), "new");
    fs::permissions(file, fs::perms::all);
    fs::permissions(folder.file(""), fs::perms(0555));
    {
        const BoundByPermissions bound;
        EXPECT_EQ(messageOf(saveFile(file, "new")), "");
        EXPECT_EQ(messageOf(saveFile(folder.file("b.glb"), "new")), "cannot be written: Permission denied");
    }
    EXPECT_EQ(contentOf(file), "new");
    fs::permissions(folder.file(""), fs::perms::owner_all);
}

} // namespace

} // namespace osgGpuAnimation::gltf
