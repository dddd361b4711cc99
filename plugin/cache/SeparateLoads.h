// SPDX-License-Identifier: MIT
#pragma once

#include <osg/ref_ptr>
#include <osgDB/Callbacks>

namespace osgGpuAnimation
{

/// Sees to it that two loads of one file never give the same character: what osgDB's object cache is to keep
/// (Options::CACHE_NODES, CACHE_OBJECTS) stays there as it was read, and each load gets a copy of the nodes. Meshes,
/// textures and animation sets are shared; files without our nodes are handed out as ever.
///
///     static SeparateLoads::Installation separateLoads; // in a plugin: from when it is loaded until it is closed
///
/// It is osgDB's read file callback, and only where there is none: an application that sets its own goes without.
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
