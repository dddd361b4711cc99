// SPDX-License-Identifier: MIT
#include "plugin/ModelImport.h"
#include "plugin/RoundTrip.h"

#include <osg/Texture2D>

#include <functional>
#include <set>
#include <string_view>

namespace osgGpuAnimation::gltf
{

namespace
{

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

struct ExportCase
{
    const char* file; ///< see modelFile()
    double compact = 0.0;
};

class ExportOfModelsTest : public ::testing::TestWithParam<ExportCase>
{
};

TEST_P(ExportOfModelsTest, comesBackWithTheSamePosesAndSurfaces)
{
    ImportOptions options;
    if (GetParam().compact > 0.0) options.compact = GetParam().compact;
    ImportedModel model;
    importOrSkip(GetParam().file, model, options);
    if (IsSkipped() || HasFatalFailure()) return;
    EXPECT_EQ(model.compacted.has_value(), options.compact.has_value());
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    ASSERT_TRUE(read);
    expectSameClips(*model.root, *read);
    EXPECT_EQ(Surfaces(*read).all, Surfaces(*model.root).all);
}

const ExportCase exportCases[] = {{"MaterialBalls.glb"},
                                  {"Serpent.glb"},
                                  {"Wanderer.glb"},
                                  {"Wanderer.glb", 1e-3},
                                  {"assets/AnimatedMorphCube/AnimatedMorphCube.gltf"},
                                  {"assets/CesiumMan/CesiumMan.glb"},
                                  {"assets/Fox/Fox.glb"},
                                  {"assets/Knight/Knight.glb"},
                                  {"assets/SimpleSkin/SimpleSkin.gltf"},
                                  {"assets/interpolation_test/interpolation_test.gltf"},
                                  {"assets/probe/probe.gltf"},
                                  {"assets/rigged_simple/rigged_simple.gltf"}};

INSTANTIATE_TEST_SUITE_P(Files, ExportOfModelsTest, ::testing::ValuesIn(exportCases),
                         [](const auto& info)
                         { return nameOfFile(info.param.file) + (info.param.compact > 0.0 ? "_compact" : ""); });

} // namespace

} // namespace osgGpuAnimation::gltf
