// SPDX-License-Identifier: MIT
// fuzz_seeds FOLDER: writes the initial corpus of fuzz_glb and fuzz_gltf into FOLDER/glb and FOLDER/gltf. Fails if the
// import refuses a seed.
#include "fuzz/Seed.h"
#include "gltf/Import.h"

#include <filesystem>
#include <fstream>
#include <iostream>

using namespace osgGpuAnimation::gltf;

int main(int count, char** arguments)
{
    if (count != 2)
    {
        std::cerr << "usage: fuzz_seeds FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    std::filesystem::create_directories(folder / "glb");
    std::filesystem::create_directories(folder / "gltf");
    std::vector<Seed> seeds = modelSeeds();
    for (Seed& seed : compressedSeeds())
        seeds.push_back(std::move(seed));
    int faults = 0;
    for (const Seed& seed : seeds)
    {
        std::ofstream(folder / "glb" / (seed.name + ".glb"), std::ios::binary) << seed.glb();
        std::ofstream(folder / "gltf" / (seed.name + ".gltf"), std::ios::binary) << seed.gltf();
        const bool standsAlone = seed.name != "external";
        const auto model = importModel(seed.glb(), "", {});
        if (model || !standsAlone) continue;
        std::cerr << seed.name << ": " << model.error().message << '\n';
        ++faults;
    }
    std::cout << seeds.size() << " seeds, " << faults << " refused\n";
    return faults == 0 ? 0 : 1;
}
