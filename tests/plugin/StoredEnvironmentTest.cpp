// SPDX-License-Identifier: MIT
#include "plugin/StoredScene.h"
#include "support/NotifyLog.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <gtest/gtest.h>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

/// Surroundings in OSG's own formats.
class StoredEnvironmentTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        environment->setIntensity(0.7f);
        environment->setRotation(1.3f);
        environment->setToneMapping(true);
        environment->setName("surroundings");
        environment->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        environment->addChild(new osg::MatrixTransform(osg::Matrix::translate(1, 2, 3)));
        osg::setNotifyHandler(log);
    }

    void TearDown() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    /// The environment from a file of that format; null if it cannot be read.
    osg::ref_ptr<Environment> read(const char* format) const
    {
        return dynamic_cast<Environment*>(files.throughFile(*environment, format).get());
    }

    std::string textOf(const std::string& file) const
    {
        std::ifstream stream(file);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    /// Colours that differ, without a file's name, so that OSG stores the pixels.
    static osg::ref_ptr<osg::Image> picture(int width, int height)
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
        for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
            image->data()[i] = static_cast<unsigned char>(11 * i);
        return image;
    }

    static bool haveSamePixels(const osg::Image& a, const osg::Image& b)
    {
        return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
               std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
    }

    StoredScene files;
    osg::ref_ptr<Environment> environment = new Environment;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

const char* const formats[] = {"osgb", "osgt", "osgx"};

} // namespace

TEST_F(StoredEnvironmentTest, settingsAndChildrenAreKept)
{
    for (const char* format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<Environment> copy = read(format);
        ASSERT_TRUE(copy);
        EXPECT_EQ(copy->getIntensity(), 0.7f);
        EXPECT_EQ(copy->getRotation(), 1.3f);
        EXPECT_TRUE(copy->getToneMapping());
        EXPECT_EQ(copy->getNumChildren(), 1u);
        EXPECT_EQ(copy->getPanorama(), nullptr);
        EXPECT_EQ(copy->getFaces(), nullptr);
        ASSERT_TRUE(copy->getStateSet());
        EXPECT_EQ(copy->getStateSet()->getMode(GL_LIGHTING), osg::StateAttribute::ON);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredEnvironmentTest, panoramasAndFacesAreKeptOnce)
{
    const osg::ref_ptr<osg::Image> panorama = picture(8, 4);
    const osg::ref_ptr<osg::TextureCubeMap> faces = new osg::TextureCubeMap;
    for (unsigned int face = 0; face < 6; ++face)
        faces->setImage(face, picture(4, 4));
    for (const char* format : formats)
    {
        SCOPED_TRACE(format);
        ASSERT_TRUE(environment->setPanorama(panorama));
        osg::ref_ptr<Environment> copy = read(format);
        ASSERT_TRUE(copy && copy->getPanorama());
        EXPECT_TRUE(haveSamePixels(*copy->getPanorama(), *panorama));
        EXPECT_EQ(copy->getFaces(), nullptr);
        EXPECT_EQ(copy->getIntensity(), 0.7f);
        ASSERT_TRUE(environment->setFaces(faces));
        copy = read(format);
        ASSERT_TRUE(copy && copy->getFaces());
        EXPECT_TRUE(haveSamePixels(*copy->getFaces()->getImage(5), *faces->getImage(5)));
        EXPECT_EQ(copy->getPanorama(), nullptr);
        // What is made of the pictures has 4.7 MB.
        EXPECT_LT(std::filesystem::file_size(files.folder.file(std::string("scene.") + format)), 20000u);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredEnvironmentTest, aPictureThatIsNoLongerThereLeavesTheStudio)
{
    const osg::ref_ptr<osg::Image> panorama = picture(8, 4);
    panorama->setFileName("no_longer_there.png");
    panorama->setWriteHint(osg::Image::EXTERNAL_FILE);
    ASSERT_TRUE(environment->setPanorama(panorama));
    for (const char* format : formats)
    {
        SCOPED_TRACE(format);
        log->text.clear();
        const osg::ref_ptr<Environment> copy = read(format);
        ASSERT_TRUE(copy);
        EXPECT_EQ(copy->getPanorama(), nullptr);
        EXPECT_NE(log->text.find("surroundings are the studio: a panorama"), std::string::npos) << log->text;
        EXPECT_EQ(copy->getIntensity(), 0.7f);
        EXPECT_EQ(copy->getNumChildren(), 1u);
    }
}

TEST_F(StoredEnvironmentTest, settingsOutOfRangeMakeTheFileUnreadable)
{
    const std::pair<const char*, const char*> faults[] = {
        {"Surroundings -1 ", "osgGpuAnimation: surroundings of the intensity -1"},
        {"Surroundings nan ", "osgGpuAnimation: surroundings of the intensity nan"},
        {"Surroundings 1e300 ", "osgGpuAnimation: surroundings of the intensity 1000000"},
        {"Surroundings many ", "expected a number, found \"many\""},
    };
    ASSERT_TRUE(read("osgt"));
    const std::string text = textOf(files.folder.file("scene.osgt"));
    const std::size_t place = text.find("Surroundings 0.");
    ASSERT_NE(place, std::string::npos) << text;
    for (const auto& [fault, message] : faults)
    {
        std::string faulty = text;
        faulty.replace(place, text.find(' ', place + 13) + 1 - place, fault);
        log->text.clear();
        EXPECT_EQ(osgDB::readRefNodeFile(files.folder.write("faulty.osgt", faulty)), nullptr) << fault;
        EXPECT_NE(log->text.find(message), std::string::npos) << log->text;
    }
}

} // namespace osgGpuAnimation
