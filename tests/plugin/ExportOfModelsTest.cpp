// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "plugin/RoundTrip.h"
#include "plugin/SharedAssets.h"

#include <osg/Texture2D>

#include <functional>
#include <set>
#include <stdexcept>
#include <string_view>

namespace osgGpuAnimation
{

namespace
{

gltf::ImportedModel modelOf(const std::string& file, const gltf::ImportOptions& options = {})
{
    const Result<std::string> bytes = gltf::readModelFile(file, options);
    if (!bytes) throw std::runtime_error(bytes.error().message);
    const Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), file, options);
    if (!model) throw std::runtime_error(model.error().message);
    return model.value();
}

/// All that shows in a picture but the vertices: shader defines, uniforms and textures, by mesh.
class Surfaces : public osg::NodeVisitor
{
public:
    explicit Surfaces(osg::Node& scene) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { scene.accept(*this); }
    void apply(osg::Drawable& drawable) override
    {
        const osg::StateSet* const state = drawable.getStateSet();
        std::string text = drawable.getName();
        for (const auto& [name, define] : state->getDefineList())
            text += ' ' + name + ' ' + define.first;
        for (const auto& [name, uniform] : state->getUniformList())
            for (unsigned int i = 0; uniform.first->getFloatArray() && i < uniform.first->getFloatArray()->size(); ++i)
                text += ' ' + name + ' ' + std::to_string((*uniform.first->getFloatArray())[i]);
        for (const auto& [mode, value] : state->getModeList())
            text += " mode " + std::to_string(mode) + ' ' + std::to_string(value);
        for (unsigned int unit = 0; unit < state->getTextureAttributeList().size(); ++unit)
            if (const auto* const texture =
                    dynamic_cast<const osg::Texture2D*>(state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE)))
            {
                const osg::Image& image = *texture->getImage();
                text += " unit " + std::to_string(unit) + ' ' + std::to_string(texture->getInternalFormat()) + ' ' +
                        std::to_string(texture->getFilter(osg::Texture::MIN_FILTER)) + ' ' +
                        std::to_string(texture->getWrap(osg::Texture::WRAP_S)) + ' ' +
                        std::to_string(std::hash<std::string_view>()(std::string_view(
                            reinterpret_cast<const char*>(image.data()), image.getTotalSizeInBytes())));
            }
        all.insert(text);
    }
    std::multiset<std::string> all;
};

struct ExportedFile
{
    const char* name; ///< see modelFile()
};

void PrintTo(const ExportedFile& file, std::ostream* out)
{
    *out << file.name;
}

class ExportOfModelsTest : public ::testing::TestWithParam<ExportedFile>
{
};

const ExportedFile exportedFiles[] = {{"MaterialBalls.glb"},
                                      {"Serpent.glb"},
                                      {"Wanderer.glb"},
                                      {"assets/AnimatedMorphCube/AnimatedMorphCube.gltf"},
                                      {"assets/CesiumMan/CesiumMan.glb"},
                                      {"assets/Fox/Fox.glb"},
                                      {"assets/Knight/Knight.glb"},
                                      {"assets/SimpleSkin/SimpleSkin.gltf"},
                                      {"assets/interpolation_test/interpolation_test.gltf"},
                                      {"assets/probe/probe.gltf"},
                                      {"assets/rigged_simple/rigged_simple.gltf"}};

TEST_P(ExportOfModelsTest, comesBackWithTheSamePosesAndSurfaces)
{
    const std::string file = modelFile(GetParam().name);
    if (file.empty()) GTEST_SKIP() << "there is no " << GetParam().name << " in " << OSGGPUANIMATION_SHARED_ASSETS;
    const gltf::ImportedModel model = modelOf(file);
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    ASSERT_TRUE(read);
    expectSameClips(*model.root, *read);
    EXPECT_EQ(Surfaces(*read).all, Surfaces(*model.root).all);
}

INSTANTIATE_TEST_SUITE_P(Files, ExportOfModelsTest, ::testing::ValuesIn(exportedFiles));

TEST(ExportOfModelsTest, compactClipsAreWrittenAsTheyAre)
{
    gltf::ImportOptions options;
    options.compact = 1e-3;
    const gltf::ImportedModel model = modelOf(ownScene("Wanderer.glb"), options);
    ASSERT_TRUE(model.compacted);
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    ASSERT_TRUE(read);
    expectSameClips(*model.root, *read);
}

/// A picture that is kept as it was is a JPEG again; others become PNG.
TEST(ExportOfModelsTest, picturesStayAsTheyWereWhereTheImportKeepsThem)
{
    SKIP_WITHOUT_SHARED_FILE("assets/CesiumMan/CesiumMan.glb");
    for (const bool keeps : {false, true})
    {
        gltf::ImportOptions options;
        options.keepEncoded = keeps;
        gltf::Messages messages;
        gltf::Report report(messages);
        const Result<std::string> glb =
            gltf::exportModel(*modelOf(sharedFile("assets/CesiumMan/CesiumMan.glb"), options).root, report);
        ASSERT_TRUE(glb);
        EXPECT_EQ(glb.value().find("\"mimeType\":\"image/jpeg\"") != std::string::npos, keeps);
        EXPECT_EQ(glb.value().find("\"mimeType\":\"image/png\"") != std::string::npos, !keeps);
    }
}

} // namespace

} // namespace osgGpuAnimation
