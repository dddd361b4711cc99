// SPDX-License-Identifier: MIT
#include "serializers/StoredTest.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <osg/MatrixTransform>

#include <cstring>
#include <filesystem>

namespace osgGpuAnimation
{

namespace
{

/// Surroundings in OSG's own formats.
class StoredEnvironmentTest : public StoredSceneTest
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
        StoredSceneTest::SetUp();
    }

    /// The environment from a file of that format; null if it cannot be read.
    osg::ref_ptr<Environment> read(const char* format) const
    {
        return dynamic_cast<Environment*>(files.throughFile(*environment, format).get());
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

    const osg::ref_ptr<Environment> environment = new Environment;
};

} // namespace

TEST_F(StoredEnvironmentTest, settingsChildrenPanoramasAndFacesAreKept)
{
    const osg::ref_ptr<osg::Image> panorama = picture(8, 4);
    const osg::ref_ptr<osg::TextureCubeMap> faces = new osg::TextureCubeMap;
    for (unsigned int face = 0; face < 6; ++face)
    {
        const osg::ref_ptr<osg::Image> image = picture(4, 4);
        image->data()[0] = static_cast<unsigned char>(face);
        faces->setImage(face, image);
    }
    for (const char* format : storedFormats)
        for (const char* kind : {"studio", "panorama", "faces"})
        {
            SCOPED_TRACE(std::string(kind) + ", " + format);
            const bool hasPanorama = *kind == 'p', hasFaces = *kind == 'f';
            ASSERT_TRUE(!hasPanorama || environment->setPanorama(panorama));
            ASSERT_TRUE(!hasFaces || environment->setFaces(faces));
            const osg::ref_ptr<Environment> copy = read(format);
            ASSERT_TRUE(copy);
            EXPECT_EQ(copy->getIntensity(), 0.7f);
            EXPECT_EQ(copy->getRotation(), 1.3f);
            EXPECT_TRUE(copy->getToneMapping());
            EXPECT_EQ(copy->getNumChildren(), 1u);
            ASSERT_TRUE(copy->getStateSet());
            EXPECT_EQ(copy->getStateSet()->getMode(GL_LIGHTING), osg::StateAttribute::ON);
            ASSERT_EQ(copy->getPanorama() != nullptr, hasPanorama);
            ASSERT_EQ(copy->getFaces() != nullptr, hasFaces);
            EXPECT_TRUE(!hasPanorama || haveSamePixels(*copy->getPanorama(), *panorama));
            for (unsigned int face = 0; hasFaces && face < 6; ++face)
                EXPECT_TRUE(haveSamePixels(*copy->getFaces()->getImage(face), *faces->getImage(face))) << face;
            // What is made of the pictures has 4.7 MB.
            EXPECT_LT(std::filesystem::file_size(files.folder.file(std::string("scene.") + format)), 20000u);
            environment->setStudio();
        }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredEnvironmentTest, aPictureThatIsNoLongerThereLeavesTheStudio)
{
    const osg::ref_ptr<osg::Image> panorama = picture(8, 4);
    panorama->setFileName("no_longer_there.png");
    panorama->setWriteHint(osg::Image::EXTERNAL_FILE);
    ASSERT_TRUE(environment->setPanorama(panorama));
    for (const char* format : storedFormats)
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
    for (const auto& [fault, message] : faults)
    {
        log->text.clear();
        const std::string text = replaced(textOf(*environment), "Surroundings 0[^ ]* ", fault);
        EXPECT_EQ(osgDB::readRefNodeFile(files.folder.write("faulty.osgt", text)), nullptr) << fault;
        EXPECT_NE(log->text.find(message), std::string::npos) << log->text;
    }
}

} // namespace osgGpuAnimation
