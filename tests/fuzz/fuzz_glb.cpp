// SPDX-License-Identifier: MIT
// libFuzzer target: the bytes of a .glb. Three of four mutations keep its container valid.
#include "fuzz/DocumentMutator.h"
#include "fuzz/ImportOnce.h"
#include "gltf/file/ModelBytes.h"
#include "plugin/GlbText.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

using namespace osgGpuAnimation;
using namespace osgGpuAnimation::gltf;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace
{

void mutateBytes(std::string& bytes, std::size_t most)
{
    const std::size_t size = bytes.size();
    bytes.resize(most);
    bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, most));
}

/// The file with a changed document or changed data in a valid container; empty if its own container is invalid.
std::string mutateWithin(const std::string& bytes, std::size_t most, std::minstd_rand& random)
{
    Messages messages;
    Report report(messages);
    const Result<GlbContainer> container = splitContainer(bytes, report);
    if (!container || !container.value().binary) return {};
    std::string json(container.value().json), binary(*container.value().binary);
    if (random() % 3 != 0)
        json = mutateDocument(json, random).value_or(json);
    else
        mutateBytes(binary, std::min(most, binary.size() + 64));
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    return glb({{jsonChunk, json}, {binaryChunk, binary}});
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    importOnce(std::string(reinterpret_cast<const char*>(data), size), "");
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed)
{
    std::minstd_rand random(seed);
    if (random() % 4 != 0)
    {
        const std::string changed = mutateWithin(std::string(reinterpret_cast<const char*>(data), size), most, random);
        if (!changed.empty() && changed.size() <= most)
        {
            std::copy(changed.begin(), changed.end(), data);
            return changed.size();
        }
    }
    return LLVMFuzzerMutate(data, size, most);
}
