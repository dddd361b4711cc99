// SPDX-License-Identifier: MIT
#include "gltf/file/SavedFile.h"
#include "gltf/ModelBuilder.h"
#include "support/Process.h"
#include "support/Results.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Transform>
#include <osgDB/ReadFile>

#include <algorithm>
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

// The stock osgconv writes characters and crowds in the formats of OSG's other plugins, in their present pose.

namespace
{

using Points = std::vector<osg::Vec3d>;

/// A sword on an arm that a clip moves by (5, 0, 0), and a triangle skinned by the arm and the hand 2 above it.
std::string armModel()
{
    gltf::ModelBuilder model;
    const int arm = model.node("arm");
    model.node("sword", arm, model.triangle());
    const int hand = model.node("hand", arm);
    model.at(hand).translation = {0, 2, 0};
    const int skinned = model.node("skinned", -1, model.skinnedTriangle());
    model.at(skinned).skin = model.skin({arm, hand});
    model.animation("held");
    model.channel(arm, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {5, 0, 0, 5, 0, 0});
    return model.text();
}

/// The corners of both triangles, +Z up.
const Points armPoints = {{5, 0, 0}, {6, 0, 0}, {5, 0, 1}, {5, 0, 1}, {6, 0, 1}, {5, 0, 2}};

class WritersTest : public ::testing::TestWithParam<std::string>
{
protected:
    void SetUp() override { setenv("OSG_LIBRARY_PATH", OSGGPUANIMATION_PLUGIN_FOLDER, 1); }

    /// What osgconv says; it must succeed.
    std::string convert(const std::string& from, const std::string& to) const
    {
        const Process osgconv = Process::run("osgconv", {from, to});
        EXPECT_EQ(osgconv.status, 0) << osgconv.err;
        return osgconv.out + osgconv.err;
    }

    static Points pointsOf(const std::string& file)
    {
        class Visitor : public osg::NodeVisitor
        {
        public:
            Visitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
            void apply(osg::Geometry& geometry) override
            {
                const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
                ASSERT_TRUE(vertices);
                const osg::Matrixd toWorld = osg::computeLocalToWorld(getNodePath());
                for (const osg::Vec3& vertex : *vertices)
                    points.push_back(osg::Vec3d(vertex) * toWorld);
            }
            Points points;
        };
        Visitor visitor;
        const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file, new osgDB::Options("noRotation")); // OBJ
        EXPECT_TRUE(read.valid()) << file;
        if (read) read->accept(visitor);
        return visitor.points;
    }

    /// Each point is near one of the others.
    static void expectWithin(const Points& points, const Points& others)
    {
        for (const osg::Vec3d& point : points)
            EXPECT_TRUE(std::any_of(others.begin(), others.end(),
                                    [&](const osg::Vec3d& other) { return (point - other).length() < 1e-4; }))
                << point.x() << " " << point.y() << " " << point.z();
    }

    /// A character that osgconv writes from that file has its present pose.
    void expectPose(const std::string& from) const
    {
        const std::string written = folder.file(std::string("arm.") + GetParam());
        const std::string said = convert(from, written);
        EXPECT_EQ(countOf("without the animation", said), 1) << said;
        EXPECT_EQ(countOf(".osgb", said), 1) << said;
        const Points found = pointsOf(written);
        EXPECT_GE(found.size(), 4u);
        expectWithin(found, armPoints);
        expectWithin(armPoints, found);
    }

    static int countOf(const std::string& word, const std::string& text)
    {
        int count = 0;
        for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
            ++count;
        return count;
    }

    ScratchFolder folder;
    const std::string model = folder.write("arm.gltf", armModel());
};

} // namespace

TEST_P(WritersTest, charactersHaveTheirPresentPose)
{
    expectPose(model);
    const std::string stored = folder.file("stored.osgb");
    EXPECT_EQ(countOf("without the animation", convert(model, stored)), 0);
    expectPose(stored);
}

TEST_P(WritersTest, crowdsHaveAllInstances)
{
    const std::string written = folder.file(std::string("arms.") + GetParam());
    const std::string said = convert(model + ".3x1.crowd", written);
    EXPECT_EQ(countOf("without the animation", said), 1) << said;
    Points found = pointsOf(written);
    const auto byPlace = [](const osg::Vec3d& a, const osg::Vec3d& b) { return a < b; };
    const auto isSame = [](const osg::Vec3d& a, const osg::Vec3d& b) { return (a - b).length() < 1e-4; };
    std::sort(found.begin(), found.end(), byPlace);
    found.erase(std::unique(found.begin(), found.end(), isSame), found.end());
    EXPECT_GE(found.size(), 3 * 4u) << "three arms of five different corners, apart";
}

const auto nameOf = [](const auto& info) { return std::string("format") + info.param; };

INSTANTIATE_TEST_SUITE_P(Formats, WritersTest, ::testing::Values("obj", "stl", "3ds", "ac", "dxf"), nameOf);

using TypedWritersTest = WritersTest;

TEST_P(TypedWritersTest, aMessageNamesTheFormatsThatKeepTheAnimation)
{
    const std::string stored = folder.file("stored.osgb");
    convert(model, stored);
    for (const std::string& from : {model, stored, model + ".3x1.crowd"})
    {
        const Process osgconv = Process::run("osgconv", {from, folder.file(std::string("arm.") + GetParam())});
        const std::string said = osgconv.out + osgconv.err;
        EXPECT_EQ(countOf(".osgb", said), 1) << said;
        EXPECT_EQ(countOf(std::string(".") + GetParam() + " cannot store characters", said), 1) << said;
    }
}

INSTANTIATE_TEST_SUITE_P(TypedFormats, TypedWritersTest, ::testing::Values("osg", "ive"), nameOf);

TEST_F(WritersTest, objHasNormals)
{
    convert(model, folder.file("arm.obj"));
    std::ifstream file(folder.file("arm.obj"));
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    EXPECT_GE(countOf("vn 0 -1 ", text), 1) << text;
}

namespace
{

namespace fs = std::filesystem;

std::string contentOf(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
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
    EXPECT_EQ(errorOf(saveFile(file, "first")), "");
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(errorOf(saveFile(file, "second")), "");
    {
        const FullDisk full(4096);
        EXPECT_EQ(errorOf(saveFile(file, large)), "cannot be written: File too large");
        EXPECT_EQ(errorOf(saveFile(folder.file("new.glb"), large)), "cannot be written: File too large");
    }
    EXPECT_EQ(contentOf(file), "second");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.file("")), {}), 1) << "no other file is left";
    EXPECT_EQ(errorOf(saveFile(file, large)), "");
    EXPECT_EQ(contentOf(file), large);
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(errorOf(saveFile(folder.file("no/a.glb"), "")), "cannot be written: No such file or directory");
    EXPECT_EQ(errorOf(saveFile(folder.file(""), "")), "cannot be written: Is a directory");
}

TEST(SavedFileTest, linksAndDevicesStayWhatTheyAre)
{
    const ScratchFolder folder;
    const std::string file = folder.write("a.glb", "old"), link = folder.file("link.glb"),
                      none = folder.file("null.glb"), full = folder.file("full.glb");
    fs::create_symlink(file, link);
    fs::create_symlink("/dev/null", none);
    fs::create_symlink("/dev/full", full);
    EXPECT_EQ(errorOf(saveFile(link, "new")), "");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(contentOf(file), "new");
    EXPECT_EQ(errorOf(saveFile(none, "new")), "");
    EXPECT_EQ(errorOf(saveFile(full, "new")), "cannot be written: No space left on device");
    EXPECT_TRUE(fs::is_symlink(none) && fs::is_symlink(full));
    // Links to links, to a file that is missing, and to themselves.
    fs::create_directory(folder.file("below"));
    fs::create_symlink("below/second.glb", folder.file("first.glb"));
    fs::create_symlink("b.glb", folder.file("below/second.glb"));
    fs::create_symlink("loop.glb", folder.file("loop.glb"));
    EXPECT_EQ(errorOf(saveFile(folder.file("first.glb"), "new")), "");
    EXPECT_TRUE(fs::is_symlink(folder.file("first.glb")) && fs::is_symlink(folder.file("below/second.glb")));
    EXPECT_EQ(contentOf(folder.file("below/b.glb")), "new");
    EXPECT_EQ(errorOf(saveFile(folder.file("loop.glb"), "new")),
              "cannot be written: Too many levels of symbolic links");
}

// Process numbers repeat, in containers within minutes.
TEST(SavedFileTest, filesOfInterruptedProgramsAreNoObstacle)
{
    const ScratchFolder folder;
    const std::string process = "a.glb." + std::to_string(getpid());
    const std::string stale[] = {folder.write(process + ".part", "old"), folder.write(process + "-0.part", "old"),
                                 folder.write(process + "-1.part", "old")};
    EXPECT_EQ(errorOf(saveFile(folder.file("a.glb"), "new")), "");
    EXPECT_EQ(contentOf(folder.file("a.glb")), "new");
    for (const std::string& file : stale)
        EXPECT_EQ(contentOf(file), "old") << file;
}

TEST(SavedFileTest, aFileIsWrittenWhereNoOtherCanBeMade)
{
    const ScratchFolder folder;
    const std::string file = folder.write("a.glb", "old"), longest = folder.file(std::string(255, 'x'));
    EXPECT_EQ(errorOf(saveFile(longest, "new")), "");
    EXPECT_EQ(contentOf(longest), "new");
    fs::permissions(file, fs::perms::all);
    fs::permissions(folder.file(""), fs::perms(0555));
    {
        const BoundByPermissions bound;
        EXPECT_EQ(errorOf(saveFile(file, "new")), "");
        EXPECT_EQ(errorOf(saveFile(folder.file("b.glb"), "new")), "cannot be written: Permission denied");
    }
    EXPECT_EQ(contentOf(file), "new");
    fs::permissions(folder.file(""), fs::perms::owner_all);
}

} // namespace

} // namespace osgGpuAnimation::gltf
