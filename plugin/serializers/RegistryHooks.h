// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/Callbacks>

namespace osgGpuAnimation
{

/// What a plugin adds to osgDB while it is loaded:
///
/// - Two loads of one file return two characters: osgDB's object cache (Options::CACHE_NODES, CACHE_OBJECTS) keeps the
///   nodes that were read, and each load returns a copy of them. The copies share meshes, textures and animation sets.
///   Files without nodes of this kit are not copied. This is osgDB's read file callback, unless the application has set
///   one.
/// - A warning when a scene with characters is written as .osg or .ive: those writers select nodes by OSG's own types
///   and leave characters out. osgDB asks all ReaderWriters in turn; ours comes first and writes nothing itself.
///
///     static RegistryHooks registryHooks; // in a plugin
class RegistryHooks
{
public:
    RegistryHooks();
    RegistryHooks(const RegistryHooks&) = delete;
    ~RegistryHooks();

private:
    // Null: the application, or another plugin, has installed one.
    osg::ref_ptr<osgDB::ReadFileCallback> _separateLoads;
    osg::ref_ptr<osgDB::ReaderWriter> _typedWriters;
};

} // namespace osgGpuAnimation
