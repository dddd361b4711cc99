// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "plugin/ModelVertices.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>
#include <osgDB/ReadFile>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A file of the shared folder cases, which other importers get wrong, and the box of its vertices.
struct SharedCase
{
    const char* file;
    const char* clip;
    double time;
    glm::dvec3 min, max;
    std::vector<std::string> warnings; ///< parts of them
};

const std::string orderFault = "animations[0] \"wave\".channels[1]: accessors[7]: expected times that increase, found ";

const SharedCase sharedCases[] = {
    {"gltf_byte_weights_254", "wave", 1.0, {99.5, 0, 0}, {100.5, 2, 0}, {}},
    {"gltf_empty_animation",
     "wave",
     0.0,
     {-0.5, 0, 0},
     {0.5, 2, 0},
     {"animations[1].channels", "animations[1].samplers"}},
    {"gltf_one_doubled_time", "wave", 0.0, {-0.5, 0, 0}, {0.5, 2, 0}, {orderFault + "0.5 twice"}},
    {"gltf_one_doubled_time", "wave", 1.0, {1, 0, 0}, {2.5, 1.5, 0}, {orderFault + "0.5 twice"}},
    {"gltf_one_unsorted_time", "wave", 1.0, {-1, 0, 0}, {0.5, 1.5, 0}, {orderFault + "0.5 after 1"}},
    {"gltf_nan_normal",
     "wave",
     0.0,
     {-0.5, 0, 0},
     {0.5, 2, 0},
     {"meshes[0].primitives[0].attributes.NORMAL: accessors[7]: expected finite numbers"}},
};

} // namespace

TEST(SharedCasesTest, verticesAreWhereTheFilesSay)
{
    for (const SharedCase& one : sharedCases)
    {
        SCOPED_TRACE(one.file);
        const std::string name = std::string("cases/") + one.file + ".gltf";
        SKIP_WITHOUT_SHARED_FILE(name);
        const ImportedModel model = imported(readBytes(sharedFile(name)), {}, sharedFile(name));
        expectWarnings(model, one.warnings);
        const int clip = model.set->findClip(one.clip);
        ASSERT_GE(clip, 0);
        const ModelVertices pose(model, clip, one.time);
        for (const ImportedPrimitive& primitive : model.primitives)
        {
            const std::vector<glm::dvec3> vertices = pose.positions(primitive);
            glm::dvec3 min = vertices.front(), max = min;
            for (const glm::dvec3& vertex : vertices)
            {
                min = glm::min(min, vertex);
                max = glm::max(max, vertex);
            }
            EXPECT_LT(glm::length(min - one.min) + glm::length(max - one.max), 1e-5)
                << min.x << ' ' << min.y << ' ' << min.z << " .. " << max.x << ' ' << max.y << ' ' << max.z;
        }
    }
}

TEST(SharedCasesTest, clipsWhoseRestPoseIsTheirFirstFramePlayAsInTheirFile)
{
    SKIP_WITHOUT_SHARED_FILE("cases/clips_rest_is_first_frame.model.gltf");
    const std::string path = sharedFile("cases/clips_rest_is_first_frame.model.gltf");
    for (const ClipMatch match : {ClipMatch::Automatic, ClipMatch::ByName})
    {
        ImportOptions options;
        options.clipsFiles = {"clips_rest_is_first_frame.clips.gltf"};
        options.clipMatch = match;
        const ImportedModel model = imported(readBytes(path), options, path);
        expectWarnings(model, {});
        const std::vector<glm::dvec3> vertices = ModelVertices(model, 0, 0.0).positions(model.primitives.at(0));
        EXPECT_LT(glm::distance(vertices[4], glm::dvec3(-1, 0.5, 0)), 1e-5) << "the top row is turned";
        EXPECT_LT(glm::distance(vertices[5], glm::dvec3(-1, 1.5, 0)), 1e-5);
    }
}

TEST(SharedCasesTest, aCrowdShowsTheWholeVehicle)
{
    SKIP_WITHOUT_SHARED_FILE("cases/gltf_crowd_of_vehicle.gltf");
    usePluginsOfTheBuild();
    const osg::ref_ptr<osg::Node> crowd =
        osgDB::readRefNodeFile(sharedFile("cases/gltf_crowd_of_vehicle.gltf") + ".1x1.crowd");
    ASSERT_TRUE(crowd);
    osg::ComputeBoundsVisitor visitor;
    crowd->accept(visitor);
    const osg::BoundingBox box = visitor.getBoundingBox(); // the body is 4 wide
    EXPECT_LE(box.xMin(), -2.0f);
    EXPECT_GE(box.xMax(), 2.0f);
    EXPECT_LE(box.zMin(), 0.0f);
    EXPECT_GE(box.zMax(), 2.0f) << "the rotor is above";
}

} // namespace osgGpuAnimation::gltf
