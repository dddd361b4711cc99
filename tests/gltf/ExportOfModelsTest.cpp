// SPDX-License-Identifier: MIT
#include "gltf/ModelImport.h"
#include "serializers/RoundTrip.h"

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

/// See modelFile(); the tolerance of compact clips, 0: they are exact.
using ExportCase = std::pair<std::string, double>;

class ExportOfModelsTest : public ::testing::TestWithParam<ExportCase>
{
};

TEST_P(ExportOfModelsTest, comesBackWithTheSamePosesAndSurfaces)
{
    ImportOptions options;
    if (GetParam().second > 0.0) options.compact = GetParam().second;
    ImportedModel model;
    importOrSkip(GetParam().first, model, options);
    if (IsSkipped() || HasFatalFailure()) return;
    EXPECT_EQ(model.compacted.has_value(), options.compact.has_value());
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    ASSERT_TRUE(read);
    expectSameClips(*model.root, *read);
    EXPECT_EQ(Surfaces(*read).all, Surfaces(*model.root).all);
}

const ExportCase exportCases[] = {{"MaterialBalls.glb", 0.0},
                                  {"Serpent.glb", 0.0},
                                  {"Wanderer.glb", 0.0},
                                  {"Wanderer.glb", 1e-3},
                                  {"assets/AnimatedMorphCube/AnimatedMorphCube.gltf", 0.0},
                                  {"assets/CesiumMan/CesiumMan.glb", 0.0},
                                  {"assets/Fox/Fox.glb", 0.0},
                                  {"assets/Knight/Knight.glb", 0.0},
                                  {"assets/SimpleSkin/SimpleSkin.gltf", 0.0},
                                  {"assets/interpolation_test/interpolation_test.gltf", 0.0},
                                  {"assets/probe/probe.gltf", 0.0},
                                  {"assets/rigged_simple/rigged_simple.gltf", 0.0}};

INSTANTIATE_TEST_SUITE_P(Files, ExportOfModelsTest, ::testing::ValuesIn(exportCases),
                         [](const auto& info)
                         { return nameOfFile(info.param.first) + (info.param.second > 0.0 ? "_compact" : ""); });

} // namespace

} // namespace osgGpuAnimation::gltf
