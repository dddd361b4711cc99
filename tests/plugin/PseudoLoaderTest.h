// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ModelBuilder.h"
#include "plugin/PluginFolder.h"
#include "support/NotifyLog.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>
#include <osgDB/Registry>

#include <stdexcept>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Tests of plugins, read through osgDB, in a folder with `arm.gltf`, which has two clips, `still.gltf`, which has no
/// animation, and `empty.gltf`, which has no mesh.
class PseudoLoaderTest : public ::testing::Test
{
protected:
    using Read = osgDB::ReaderWriter::ReadResult;

    PseudoLoaderTest()
    {
        usePluginsOfTheBuild();
        ModelBuilder empty;
        empty.node("nothing");
        folder.write("empty.gltf", empty.text());
        ModelBuilder still;
        still.node("stone", -1, still.triangle());
        folder.write("still.gltf", still.text());
        arm.node("sword", arm.node("arm"), arm.triangle());
        arm.slidingClip("Slow slide", 0);
        arm.slidingClip("Slide", 0);
        folder.write("arm.gltf", arm.text());
        osg::setNotifyHandler(log);
    }
    ~PseudoLoaderTest() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    Read read(const std::string& name, const std::string& options = "")
    {
        const osg::ref_ptr<osgDB::Options> held = new osgDB::Options(options);
        return osgDB::Registry::instance()->readNode(folder.file(name), held);
    }

    /// The reader of an extension; it knows these options.
    static osgDB::ReaderWriter& readerOf(const std::string& extension, const std::vector<const char*>& options)
    {
        osgDB::ReaderWriter* const reader = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
        if (!reader) throw std::runtime_error("no reader of ." + extension);
        for (const char* option : options)
            EXPECT_EQ(reader->supportedOptions().count(option), 1u) << option;
        return *reader;
    }

    /// The file cannot be read, and the message has that part.
    void expectError(const std::string& name, const std::string& options, const std::string& part)
    {
        const Read result = read(name, options);
        EXPECT_EQ(result.status(), Read::ERROR_IN_READING_FILE) << name << ' ' << options;
        EXPECT_NE(result.message().find(part), std::string::npos) << name << ' ' << options << result.message();
    }

    ModelBuilder arm;
    ScratchFolder folder;
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::NOTICE);
};

} // namespace osgGpuAnimation::gltf
