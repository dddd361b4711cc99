// SPDX-License-Identifier: MIT
#include "tool/CommandLine.h"

#include <osg/Version>
#include <osgDB/Callbacks>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <exception>
#include <iostream>
#include <string>

namespace osgGpuAnimation::tool
{

/// Libraries come from the library path alone. OSG would also open osgPlugins-3.6.5/ in the current folder, where files
/// of any origin may be.
class LibraryPathOnly : public osgDB::FindFileCallback
{
public:
    /// Removes empty elements, which mean the current folder.
    LibraryPathOnly()
    {
        osgDB::FilePathList& folders = osgDB::Registry::instance()->getLibraryFilePathList();
        folders.erase(std::remove(folders.begin(), folders.end(), ""), folders.end());
    }

    std::string findLibraryFile(const std::string& name, const osgDB::Options*, osgDB::CaseSensitivity how) override
    {
        const std::string simple = osgDB::getSimpleFileName(name);
        for (const std::string& folder : {"osgPlugins-" + std::string(osgGetVersion()) + "/", std::string()})
        {
            const std::string found =
                osgDB::findFileInPath(folder + simple, osgDB::Registry::instance()->getLibraryFilePathList(), how);
            if (!found.empty()) return found;
        }
        return "/dev/null/" + simple; // for an empty name OSG would try the current folder; no file is below a device
    }
};

} // namespace osgGpuAnimation::tool

int main(int argc, char** argv)
{
    try
    {
        osgDB::Registry::instance()->setFindFileCallback(new osgGpuAnimation::tool::LibraryPathOnly);
        return osgGpuAnimation::tool::CommandLine().run(argc, argv);
    }
    catch (const std::exception& fault)
    {
        // For example, out of memory.
        std::cerr << "osggpuanim: " << fault.what() << std::endl;
        return 1;
    }
}
