// SPDX-License-Identifier: MIT
// libFuzzer target: the bytes of a .glb. Three of four mutations keep its container valid.
#include "fuzz/Fuzzing.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/GlbText.h"

using namespace osgGpuAnimation;
using namespace osgGpuAnimation::gltf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    importOnce(data, size, "");
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed)
{
    const auto changeWithin = [&](const std::string& bytes, std::minstd_rand& random) -> std::optional<std::string>
    {
        Messages messages;
        Report report(messages);
        const Result<GlbContainer> container = splitContainer(bytes, report);
        if (!container || !container.value().binary) return std::nullopt;
        std::string json(container.value().json), binary(*container.value().binary);
        if (random() % 3 != 0)
            json = mutateDocument(json, random).value_or(json);
        else
            mutateBytes(binary, std::min(most, binary.size() + 64));
        return packedGlb(json, binary);
    };
    return mutate(data, size, most, seed, changeWithin);
}
