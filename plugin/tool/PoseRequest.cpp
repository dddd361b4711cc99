// SPDX-License-Identifier: MIT
#include "tool/PoseRequest.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace osgGpuAnimation::tool
{

namespace
{

using nlohmann::json;

void readSampled(const json& primitives, PoseRequest& request)
{
    for (const json& primitive : primitives)
    {
        const PoseRequest::PrimitiveKey key(primitive.at("node").get<int>(), primitive.at("primitive").get<int>());
        request.sampled[key] = primitive.at("sampled").get<std::vector<std::uint32_t>>();
    }
}

PoseRequest readRequest(const json& document)
{
    PoseRequest request;
    const json& clip = document.at("clip");
    request.bind = clip.is_null();
    if (!request.bind) request.animation = clip.at("index").get<int>();
    for (const json& frame : document.at("frames"))
        request.times.push_back(frame.at("time").get<double>());
    if (document.contains("fixedWeights"))
    {
        for (const json& fixed : document["fixedWeights"])
            request.fixedWeights.push_back(
                {fixed.at("node").get<int>(), fixed.at("weights").get<std::vector<double>>()});
    }
    if (document.contains("primitives")) readSampled(document["primitives"], request);
    return request;
}

} // namespace

Result<PoseRequest> readPoseRequest(const std::string& fileName)
{
    std::ifstream file(fileName, std::ios::binary);
    if (!file) return Error{"cannot be read"};
    try
    {
        const json document = json::parse(file);
        if (!document.is_object() || document.value("schema", "") != "gltf-pose/1")
            return Error{"is not a document of schema gltf-pose/1"};
        return readRequest(document);
    }
    catch (const json::exception& fault)
    {
        return Error{fault.what()};
    }
    catch (const std::ios_base::failure&)
    {
        return Error{"cannot be read"};
    }
}

} // namespace osgGpuAnimation::tool
