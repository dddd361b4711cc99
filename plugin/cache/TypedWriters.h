// SPDX-License-Identifier: MIT
#pragma once

#include <osg/ref_ptr>
#include <osgDB/ReaderWriter>

namespace osgGpuAnimation
{

/// Says so when a scene with characters is written as .osg or .ive: those writers select nodes by OSG's own types and
/// leave characters out. osgDB asks all ReaderWriters in turn; this one comes first and writes nothing itself.
///
///     static TypedWriters::Installation typedWriters; // in a plugin: installed while the plugin is loaded
class TypedWriters : public osgDB::ReaderWriter
{
public:
    class Installation
    {
    public:
        Installation();
        Installation(const Installation&) = delete;
        ~Installation();

    private:
        osg::ref_ptr<TypedWriters> _writer; ///< null: another plugin has installed it
    };

    const char* className() const override { return "osgGpuAnimation message about .osg and .ive"; }
    bool acceptsExtension(const std::string&) const override { return false; }
    WriteResult writeNode(const osg::Node& node, const std::string& fileName, const Options* options) const override;

protected:
    ~TypedWriters() override = default;
};

} // namespace osgGpuAnimation
