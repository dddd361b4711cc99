// SPDX-License-Identifier: MIT
#pragma once

#include <osg/ref_ptr>
#include <osgDB/Callbacks>

namespace osgGpuAnimation
{

/// Makes two loads of one file return two characters: osgDB's object cache (Options::CACHE_NODES, CACHE_OBJECTS) keeps
/// the nodes that were read, and each load returns a copy of them. The copies share meshes, textures and animation
/// sets. Files without nodes of this kit are not copied.
///
///     static SeparateLoads::Installation separateLoads; // in a plugin: installed while the plugin is loaded
///
/// It installs itself as osgDB's read file callback unless the application has set one.
class SeparateLoads : public osgDB::ReadFileCallback
{
public:
    using Result = osgDB::ReaderWriter::ReadResult;

    class Installation
    {
    public:
        Installation();
        Installation(const Installation&) = delete;
        ~Installation();

    private:
        osg::ref_ptr<SeparateLoads> _callback;
    };

    Result readObject(const std::string& file, const osgDB::Options* options) override;
    Result readNode(const std::string& file, const osgDB::Options* options) override;

protected:
    ~SeparateLoads() override = default;
};

} // namespace osgGpuAnimation
