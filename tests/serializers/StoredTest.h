// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ModelBuilder.h"
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/NotifyLog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>

namespace osgGpuAnimation
{

/// Tests that store scenes and keep what OSG says about them.
class StoredSceneTest : public ::testing::Test
{
protected:
    void SetUp() override { osg::setNotifyHandler(log); }
    void TearDown() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    void readModel(const gltf::ModelBuilder& model)
    {
        scene = osgDB::readRefNodeFile(files.folder.write("model.gltf", model.text()));
        ASSERT_TRUE(scene);
    }

    AnimatedCharacter& character() { return *findCharacter(*scene); }

    /// The scene's character from a file of that format. The test fails without one.
    osg::ref_ptr<AnimatedCharacter> read(const char* format)
    {
        const osg::ref_ptr<osg::Node> node = files.throughFile(*scene, format);
        EXPECT_TRUE(node && findCharacter(*node)) << format;
        return node ? findCharacter(*node) : nullptr;
    }

    /// The node's .osgt.
    std::string textOf(const osg::Node& node) const
    {
        const std::string file = files.folder.file("text.osgt");
        EXPECT_TRUE(osgDB::writeNodeFile(node, file));
        return readBytes(file);
    }

    /// What is read from a file of that content; the log has its messages alone.
    osgDB::ReaderWriter::ReadResult readContent(const std::string& name, const std::string& content)
    {
        log->text.clear();
        return osgDB::Registry::instance()->readNode(files.folder.write(name, content), nullptr);
    }

    StoredScene files;
    osg::ref_ptr<osg::Node> scene;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

/// A text in which the first match of a pattern is replaced. The test fails without one. Lines end with LF, though
/// Windows writes CR LF.
inline std::string replaced(std::string text, const char* pattern, const char* instead)
{
    text.erase(std::remove(text.begin(), text.end(), '\r'), text.end());
    const auto once = std::regex_constants::format_first_only;
    const std::string made = std::regex_replace(text, std::regex(pattern), instead, once);
    EXPECT_NE(made, text) << "the pattern is not in the file: " << pattern;
    return made;
}

/// A sword on an arm that slides (two clips), and a skinned triangle; read through osgDB.
class StoredArmTest : public StoredSceneTest
{
protected:
    void SetUp() override
    {
        gltf::ModelBuilder model;
        const int arm = model.node("arm \"1\" <&{ä");
        model.node("sword", arm, model.triangle());
        const int skinned = model.node("skinned", -1, model.skinnedTriangle());
        model.at(skinned).skin = model.skin({arm, model.node("hand", arm)});
        model.slidingClip("Slow slide", arm);
        model.animation("");
        model.channel(arm, "rotation", {0, 2}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0, 1, 0, 0});
        readModel(model);
        StoredSceneTest::SetUp();
    }
};

} // namespace osgGpuAnimation
