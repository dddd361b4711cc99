// SPDX-License-Identifier: MIT
#pragma once

#include "plugin/ModelBuilder.h"
#include "plugin/PluginFolder.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>
#include <osgDB/Registry>

namespace osgGpuAnimation::gltf
{

/// Tests of a plugin whose file names contain another file's, in a folder with `arm.gltf`, which has two clips,
/// `still.gltf`, which has no animation, and `empty.gltf`, which has no mesh.
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
        ModelBuilder arm;
        arm.node("sword", arm.node("arm"), arm.triangle());
        arm.animation("Slow slide");
        arm.slide(0);
        arm.animation("Slide");
        arm.slide(0);
        folder.write("arm.gltf", arm.text());
    }

    Read read(const std::string& name, const std::string& options = "")
    {
        const osg::ref_ptr<osgDB::Options> held = new osgDB::Options(options);
        return osgDB::Registry::instance()->readNode(folder.file(name), held);
    }

    ScratchFolder folder;
};

} // namespace osgGpuAnimation::gltf
