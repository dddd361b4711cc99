// SPDX-License-Identifier: MIT
#include "tool/SmallGltf.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using nlohmann::json;

std::string base64(const std::vector<float>& numbers)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes(numbers.size() * sizeof(float));
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    while (bytes.size() % 3 != 0)
        bytes.push_back(0); // a buffer may be longer than its byteLength
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        const unsigned int three = bytes[i] * 65536u + bytes[i + 1] * 256u + bytes[i + 2];
        for (int shift = 18; shift >= 0; shift -= 6)
            text += letters[three >> shift & 63u];
    }
    return text;
}

} // namespace

std::string swingingFlag()
{
    const std::vector<float> numbers{
        -1, -1, 0, 1, -1, 0, -1,          1,           0, 1, 1, 0, // bytes 0: corners
        0,  0,  1, 0, 0,  1, 0,           0,           1, 0, 0, 1, // 48: normals
        0,  2,                                                     // 96: times of Swing
        0,  0,  0, 1, 0,  0, 0.70710678f, 0.70710678f,             // 104: rotations
        0,  1,                                                     // 136: times of Rise
        0,  0,  0, 0, 1,  0,                                       // 144: translations; 168 in all
    };
    return R"({"asset":{"version":"2.0","generator":"SmallGltf"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"hinge","children":[1]},{"name":"flag","mesh":0,"translation":[0,1,0]}],
"meshes":[{"name":"cloth","primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"mode":5,"material":0}]}],
"materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.05,0.05,1]},"doubleSided":true}],
"animations":[
{"name":"Swing","channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}],"samplers":[{"input":2,"output":3}]},
{"name":"Rise","channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":4,"output":5}]}],
"accessors":[
{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},
{"bufferView":3,"componentType":5126,"count":2,"type":"VEC4"},
{"bufferView":4,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
{"bufferView":5,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[
{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48},
{"buffer":0,"byteOffset":96,"byteLength":8},{"buffer":0,"byteOffset":104,"byteLength":32},
{"buffer":0,"byteOffset":136,"byteLength":8},{"buffer":0,"byteOffset":144,"byteLength":24}],
"buffers":[{"byteLength":168,"uri":"data:application/octet-stream;base64,)" +
           base64(numbers) + "\"}]}\n";
}

std::string renamedFlag(const char* hinge, const char* flag)
{
    json document = json::parse(swingingFlag());
    document["nodes"][0]["name"] = hinge;
    document["nodes"][1]["name"] = flag;
    return document.dump();
}

std::string filmedFlag()
{
    json document = json::parse(swingingFlag());
    document["cameras"] = json::parse(R"([{"name":"film","type":"perspective","perspective":{"yfov":1,"znear":0.1}},
        {"name":"plan","type":"orthographic","orthographic":{"xmag":4,"ymag":4,"znear":0.1,"zfar":99}}])");
    document["extensionsUsed"] = {"KHR_lights_punctual"};
    document["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([{"name":"sun","type":"directional"}])");
    document["nodes"].push_back({{"camera", 0}, {"translation", {0, 1, 5}}});
    document["nodes"].push_back({{"camera", 1}, {"translation", {0, 0, 5}}});
    document["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    document["nodes"][0]["children"] = {1, 2};
    document["scenes"][0]["nodes"] = {0, 3, 4};
    return document.dump();
}

} // namespace osgGpuAnimation
