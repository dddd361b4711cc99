// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "gltf/ImportOptions.h"
#include "plugin/SharedAssets.h"
#include "support/PoseErrors.h"

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

struct ModelCase
{
    const char* name;
    std::string file;
    double compact;        ///< tolerance, relative to the model's longest side
    std::size_t mostBytes; ///< of keyframes on the GPU
};

void PrintTo(const ModelCase& model, std::ostream* out)
{
    *out << model.name;
}

/// The bounds of the vertices that each palette entry moves.
EntryBoxes boxesOf(const ImportedModel& model)
{
    PaletteEntryBounds reach(*model.set);
    for (const ImportedPrimitive& primitive : model.primitives)
        if (auto* mesh = dynamic_cast<SkinnedGeometry*>(primitive.geometry.get())) reach.add(*mesh);
    return reach.boxes();
}

class CompactModelsTest : public ::testing::TestWithParam<ModelCase>
{
};

TEST_P(CompactModelsTest, areSmallAndWithinTheErrorAskedFor)
{
    const std::string& file = GetParam().file;
    if (!std::filesystem::is_regular_file(file)) GTEST_SKIP() << "there is no " << file;
    ImportOptions options;
    const Result<ImportedModel> exact = importModel(readBytes(file), file, options);
    ASSERT_TRUE(exact) << exact.error().message;
    EXPECT_FALSE(exact.value().compacted);
    options.compact = GetParam().compact;
    const Result<ImportedModel> compact = importModel(readBytes(file), file, options);
    ASSERT_TRUE(compact) << compact.error().message;
    ASSERT_TRUE(compact.value().compacted);

    const std::size_t bytes = PackedKeyframes(*compact.value().set).byteSize();
    RecordProperty("bytes", std::to_string(bytes));
    EXPECT_LE(bytes, GetParam().mostBytes);
    EXPECT_EQ(&compact.value().character->getAnimationSet(), compact.value().set.get());
    const EntryBoxes boxes = boxesOf(exact.value());
    const double tolerance = GetParam().compact * compact.value().compacted->longestSide;
    ASSERT_EQ(compact.value().set->clips().size(), exact.value().set->clips().size());
    for (int clip = 0; clip < static_cast<int>(exact.value().set->clips().size()); ++clip)
        // Between the tested times the error may be slightly larger.
        EXPECT_LE(largestDistance(*exact.value().set, *compact.value().set, clip, boxes, 20), 1.05 * tolerance)
            << exact.value().set->clips()[static_cast<std::size_t>(clip)].name();
}

std::string shared(const char* name)
{
    return std::string(OSGGPUANIMATION_SHARED_ASSETS) + "/assets/" + name;
}

INSTANTIATE_TEST_SUITE_P(Models, CompactModelsTest,
                         ::testing::Values(ModelCase{"Knight", shared("Knight/Knight.glb"), 1e-4, 450000},
                                           ModelCase{"Knight, coarse", shared("Knight/Knight.glb"), 1e-3, 340000},
                                           ModelCase{"Knight, fine", shared("Knight/Knight.glb"), 1e-5, 540000},
                                           ModelCase{"Fox", shared("Fox/Fox.glb"), 1e-4, 13000},
                                           ModelCase{"CesiumMan", shared("CesiumMan/CesiumMan.glb"), 1e-4, 8000},
                                           ModelCase{"Wanderer", OSGGPUANIMATION_SCENES "/Wanderer.glb", 1e-4, 29000},
                                           ModelCase{"Serpent", OSGGPUANIMATION_SCENES "/Serpent.glb", 1e-4, 22000}));

} // namespace

} // namespace osgGpuAnimation::gltf
