// SPDX-License-Identifier: MIT
// libFuzzer target: the text of a .gltf in its own folder with a data.bin and a picture.png.
#include "fuzz/DocumentMutator.h"
#include "fuzz/ImportOnce.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

using namespace osgGpuAnimation::gltf;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

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
    importOnce(std::string(reinterpret_cast<const char*>(data), size), folder.model());
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed)
{
    std::minstd_rand random(seed);
    if (random() % 4 != 0)
    {
        const auto text = mutateDocument(std::string(reinterpret_cast<const char*>(data), size), random);
        if (text && text->size() <= most)
        {
            std::copy(text->begin(), text->end(), data);
            return text->size();
        }
    }
    return LLVMFuzzerMutate(data, size, most);
}
