// SPDX-License-Identifier: MIT
#include "nodes/OutfitCrowd.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/nodes/OutfitsFile.h>

#include <fstream>

namespace osgGpuAnimation
{

namespace
{

/// The outfits of a file with this text.
Result<std::vector<OutfitShare>> read(const ScratchFolder& folder, const std::string& text)
{
    const std::string file = folder.file("people.outfits.json");
    std::ofstream(file) << text;
    return readOutfitsFile(file);
}

TEST(OutfitsFileTest, hasWhatOutfitsHave)
{
    const ScratchFolder folder;
    const Result<std::vector<OutfitShare>> outfits =
        read(folder, R"({ "outfits": [ { "name": "pilgrim", "share": 2.5, "size": 0.75, "hide": ["Hat", "Cap"],
            "show": "Hood", "variant": "winter", "colors": { "Coat": "#ff8000" } }, { "size": [1.2, 1.1, 0.9],
            "proportions": { "Head": [1.5, 1, 2] } } ] })");
    ASSERT_TRUE(hasError(outfits, ""));
    ASSERT_EQ(outfits.value().size(), 2u);
    const OutfitShare& pilgrim = outfits.value()[0];
    EXPECT_EQ(pilgrim.share, 2.5);
    EXPECT_EQ(pilgrim.size, osg::Vec3d(0.75, 0.75, 0.75));
    EXPECT_EQ(pilgrim.outfit->getName(), "pilgrim");
    EXPECT_EQ(pilgrim.outfit->getVariant(), "winter");
    EXPECT_EQ(pilgrim.outfit->getVisibility(),
              (std::map<std::string, bool>{{"Hat", false}, {"Cap", false}, {"Hood", true}}));
    EXPECT_EQ(pilgrim.outfit->getColors().at("Coat"), osg::Vec4(1, 128 / 255.0f, 0, 1));
    EXPECT_EQ(outfits.value()[1].share, 1.0);
    EXPECT_EQ(outfits.value()[1].size, osg::Vec3d(1.2, 1.1, 0.9));
    EXPECT_EQ(outfits.value()[1].outfit->getJointScales().at("Head"), osg::Vec3(1.5f, 1, 2));
}

TEST(OutfitsFileTest, faultsNameTheMember)
{
    const ScratchFolder folder;
    EXPECT_TRUE(hasError(readOutfitsFile(folder.file("none.json")), "none.json: the file does not exist"));
    const struct
    {
        const char* outfit;
        const char* message;
    } cases[] = {
        {R"("hat")", "outfits[0]: expected an object, found string"},
        {R"({ "hides": "Hat" })", "outfits[0]: unknown member \"hides\""},
        {R"({ "hide": [3] })", "outfits[0].hide: expected a string, found number"},
        {R"({ "share": -1 })", "outfits[0].share: expected at least 0"},
        {R"({ "share": 0 })", "outfits: there is none with a share above 0"},
        {R"({ "size": 0 })", "outfits[0].size: expected above 0"},
        {R"({ "size": [1, 1, -1] })", "outfits[0].size: expected above 0"},
        {R"({ "proportions": { "Head": 0 } })", "outfits[0].proportions.Head: expected above 0"},
        {R"({ "size": [1, 1] })", "outfits[0].size: expected a number or an array of three numbers"},
        {R"({ "colors": { "Coat": "red" } })", "outfits[0].colors.Coat: \"red\" is no colour like \"#7a5c3a\""},
        {R"({ "colors": ["#000000"] })", "outfits[0].colors: expected an object, found array"},
        {R"({ "pictures": { "Coat": "../secret.png" } })",
         "outfits[0].pictures.Coat: \"../secret.png\" is not in the folder"},
        {R"({ "pictures": { "Coat": "/etc/passwd" } })", "is not in the folder of the file"},
        {R"({ "pictures": { "Coat": "none.png" } })", "none.png is no picture that can be read"},
        {R"({ "props": [ { "file": "hat.glb" } ] })", "outfits[0].props[0]: it has no \"joint\""},
        {R"({ "props": [ { "joint": "Head", "file": "none.osgt" } ] })", "none.osgt is no model that can be read"},
        {R"({ "name": "a", "name": "b" })", "member \"name\" comes twice"},
    };
    for (const auto& each : cases)
    {
        const Result<std::vector<OutfitShare>> outfits =
            read(folder, std::string(R"({ "outfits": [ )") + each.outfit + " ] }");
        EXPECT_TRUE(hasError(outfits, each.message)) << each.outfit;
        EXPECT_TRUE(hasError(outfits, "people.outfits.json: ")) << each.outfit;
    }
}

} // namespace

} // namespace osgGpuAnimation
