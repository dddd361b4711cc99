// SPDX-License-Identifier: MIT
#pragma once

#include "plugin/ModelBuilder.h"
#include "plugin/StoredScene.h"
#include "support/NotifyLog.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace osgGpuAnimation
{

/// OSG's own formats, without the dot.
constexpr const char* storedFormats[] = {"osgb", "osgt", "osgx"};

/// A sword on an arm that slides (two clips), and a skinned triangle; read through osgDB.
class StoredArmTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        gltf::ModelBuilder model;
        const int arm = model.node("arm \"1\" <&{ä");
        model.node("sword", arm, model.triangle());
        const int skinned = model.node("skinned", -1, model.skinnedTriangle());
        model.at(skinned).skin = model.skin({arm, model.node("hand", arm)});
        model.animation("Slow slide");
        model.slide(arm);
        model.animation("");
        model.channel(arm, "rotation", {0, 2}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0, 1, 0, 0});
        scene = osgDB::readRefNodeFile(files.folder.write("arm.gltf", model.text()));
        ASSERT_TRUE(scene);
        osg::setNotifyHandler(log);
    }

    void TearDown() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    AnimatedCharacter& character() { return *findCharacter(*scene); }

    /// The node's .osgt.
    std::string textOf(const osg::Node& node) const
    {
        const std::string file = files.folder.file("text.osgt");
        EXPECT_TRUE(osgDB::writeNodeFile(node, file));
        std::ifstream stream(file);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    }

    StoredScene files;
    osg::ref_ptr<osg::Node> scene;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

} // namespace osgGpuAnimation
