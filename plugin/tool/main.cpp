// SPDX-License-Identifier: MIT
#include "tool/CommandLine.h"

#include <exception>
#include <iostream>

int main(int argc, char** argv)
{
    try
    {
        return osgGpuAnimation::tool::CommandLine().run(argc, argv);
    }
    catch (const std::exception& fault)
    {
        // For example, out of memory.
        std::cerr << "osggpuanim: " << fault.what() << std::endl;
        return 1;
    }
}
