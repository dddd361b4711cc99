// SPDX-License-Identifier: MIT
#include "gltf/PointerFile.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The first weight of a morph at the end of a clip.
float weightAtEnd(const ImportedModel& model, std::size_t clip, std::size_t morph)
{
    const Clip& played = model.set->clips().at(clip);
    return played.at(played.keyframeCount() - 1, model.set->firstTrackOfMorph(morph))->number(0);
}

/// Each animation may animate what another one animates, and has its own channels alone.
TEST(SecondVisitsTest, pointersOfOneAnimationAreForgottenInTheNext)
{
    PointerFile file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(9, 1.0f))}}};
    file.node("left", -1, mesh);
    file.node("right", -1, mesh);
    file.animation("both");
    file.animate("/meshes/0/weights", TINYGLTF_TYPE_SCALAR, {0, 1});
    file.animation("left");
    file.animate("/nodes/0/weights/0", TINYGLTF_TYPE_SCALAR, {0, 0.5f});
    file.animation("left again");
    file.animate("/nodes/0/weights/0", TINYGLTF_TYPE_SCALAR, {0, 0.25f});
    file.animate("/nodes/0/translation", TINYGLTF_TYPE_VEC3, {0, 0, 0, 3, 0, 0});
    file.animation("both again");
    file.animate("/meshes/0/weights", TINYGLTF_TYPE_SCALAR, {0, 0.75f});
    file.animate("/nodes/0/translation", TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0});
    const ImportedModel model = importedFrom(file.document()); // without a warning
    ASSERT_TRUE(model.set);
    ASSERT_EQ(model.set->clips().size(), 4u);
    const float expected[][2] = {{1, 1}, {0.5f, 0}, {0.25f, 0}, {0.75f, 0.75f}};
    for (std::size_t clip = 0; clip < 4; ++clip)
        for (std::size_t morph = 0; morph < 2; ++morph)
            EXPECT_EQ(weightAtEnd(model, clip, morph), expected[clip][morph]) << clip << ' ' << morph;
    const Clip& last = model.set->clips()[3];
    EXPECT_EQ(last.at(last.keyframeCount() - 1, 0)->translation.x, 5.0f);
}

} // namespace

} // namespace osgGpuAnimation::gltf
