// SPDX-License-Identifier: MIT
#include "MaterialBalls.h"
#include "people/People.h"
#include "serpent/Serpent.h"
#include "wanderer/Wanderer.h"

#include <exception>
#include <iostream>
#include <string>

int main(int argc, char** argv)
{
    const std::string argument = argc == 2 ? argv[1] : "";
    if (argument.empty() || argument[0] == '-')
    {
        const bool asked = argument == "--help" || argument == "-h";
        (asked ? std::cout : std::cerr) << "usage: make_scenes FOLDER\n"
                                           "Writes the project's own scenes, Wanderer.glb, People.glb, Serpent.glb "
                                           "and MaterialBalls.glb, into an existing folder.\n";
        return asked ? 0 : 2;
    }
    try
    {
        osgGpuAnimation::scenes::writeWanderer(argument + "/Wanderer.glb");
        osgGpuAnimation::scenes::writePeople(argument + "/People.glb");
        osgGpuAnimation::scenes::writeSerpent(argument + "/Serpent.glb");
        osgGpuAnimation::scenes::writeMaterialBalls(argument + "/MaterialBalls.glb");
        return 0;
    }
    catch (const std::exception& error)
    {
        std::cerr << "make_scenes: " << error.what() << '\n';
        return 1;
    }
}
