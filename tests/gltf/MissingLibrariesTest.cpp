// SPDX-License-Identifier: MIT
#include "gltf/PackedDocument.h"

#include <gtest/gtest.h>

// What a file that needs a library hears if the kit was built without it. PictureTest has WebP.

namespace osgGpuAnimation::gltf
{

namespace
{

PackedDocument documentOf(const char* extension, const char* members)
{
    PackedDocument document;
    document.addView(std::string(64, '\0'));
    document.json.update(nlohmann::json::parse(members), true);
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = {extension};
    return document;
}

struct Case
{
    const char* library;
    bool isMissing;
    const char* extension;
    const char* members; ///< of a document whose first buffer is 64 zeros
    const char* element; ///< in the message
};

const Case libraryCases[] = {
    {"meshoptimizer", !OSGGPUANIMATION_WITH_MESHOPTIMIZER, "EXT_meshopt_compression",
     R"({"bufferViews":[{"buffer":0,"byteLength":64,"extensions":{"EXT_meshopt_compression":
         {"buffer":0,"byteLength":64,"byteStride":4,"count":16,"mode":"ATTRIBUTES"}}}]})",
     "bufferViews[0].extensions.EXT_meshopt_compression: the view"},
    {"Draco", !OSGGPUANIMATION_WITH_DRACO, "KHR_draco_mesh_compression",
     R"({"accessors":[{"componentType":5126,"count":3,"type":"VEC3"},{"componentType":5123,"count":3,"type":"SCALAR"}],
         "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":
         {"bufferView":0,"attributes":{"POSITION":0}}}}]}]})",
     "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: the primitive"}};

} // namespace

TEST(MissingLibrariesTest, areNamed)
{
    for (const Case& each : libraryCases)
    {
        const std::string sentence =
            std::string(each.element) + " needs " + each.library + ", without which this osgGpuAnimation was built";
        const std::string error = documentOf(each.extension, each.members).error();
        EXPECT_EQ(error == sentence, each.isMissing) << error;
        EXPECT_NE(error, "") << "zeros are no compressed data";
    }
}

} // namespace osgGpuAnimation::gltf
