// SPDX-License-Identifier: MIT
// libFuzzer target: the text of a .gltf in its own folder with a data.bin and a picture.png.
#include "fuzz/Fuzzing.h"

#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace osgGpuAnimation::gltf;

namespace
{

/// The model's folder; it contains only these two files.
class Folder
{
public:
    Folder()
    {
        std::filesystem::create_directories(_path);
        std::ofstream(_path / "data.bin", std::ios::binary) << std::string(512, '\x3f') + std::string(512, '\0');
        std::ofstream(_path / "picture.png", std::ios::binary) << "\x89PNG\r\n\x1a\n";
    }
    ~Folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }

    std::string model() const { return (_path / "model.gltf").string(); }

private:
    std::filesystem::path _path =
        std::filesystem::temp_directory_path() / ("osggpuanimation_fuzz_" + std::to_string(::getpid()));
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const Folder folder;
    importOnce(data, size, folder.model());
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed)
{
    return mutate(data, size, most, seed, mutateDocument);
}
