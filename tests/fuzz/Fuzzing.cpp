// SPDX-License-Identifier: MIT
#include "fuzz/Fuzzing.h"

#include "gltf/Import.h"

#include <nlohmann/json.hpp>
#include <osg/Notify>

#include <algorithm>
#include <iterator>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

const Json numbers[] = {-1,   0,      1,     2,      3,     4,         5,          6,         15,
                        16,   255,    256,   65535,  65536, 1 << 24,   5120,       5121,      5122,
                        5123, 5125,   5126,  9728,   33071, 0.5,       8.0,        -1.5,      1e-30,
                        1e30, 3.4e38, -3e38, 1e-320, 1e308, INT32_MAX, UINT32_MAX, INT64_MAX, UINT64_MAX};
const Json others[] = {nullptr,   true,          false,         "", "POSITION", "LINEAR", "CUBICSPLINE", "STEP",
                       "weights", Json::array(), Json::object()};

/// True if the document is too deep for the recursive writer.
bool isDeep(const std::string& text)
{
    int depth = 0, deepest = 0;
    for (const char c : text)
    {
        depth += (c == '[' || c == '{') - (c == ']' || c == '}');
        deepest = std::max(deepest, depth);
    }
    return deepest > 64;
}

std::size_t below(std::size_t count, std::minstd_rand& random)
{
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

template <typename List>
auto& anyOf(List& list, std::minstd_rand& random)
{
    return *std::next(std::begin(list), static_cast<std::ptrdiff_t>(below(std::size(list), random)));
}

void replace(Json& value, const Json& sibling, std::minstd_rand& random)
{
    if (value.is_number_integer() && below(2, random) == 0)
        value = static_cast<std::int64_t>(value.get<std::uint64_t>() + below(5, random) - 2); // wraps round
    else if (below(4, random) == 0)
        value = sibling;
    else if (value.is_number() || below(2, random) == 0)
        value = anyOf(numbers, random);
    else
        value = anyOf(others, random);
}

/// Changes a member of one array or object at random.
void change(Json& document, std::minstd_rand& random)
{
    std::vector<Json*> containers, open = {&document};
    while (!open.empty())
    {
        Json* value = open.back();
        open.pop_back();
        if (!value->is_structured() || value->empty()) continue;
        containers.push_back(value);
        for (Json& child : *value)
            open.push_back(&child);
    }
    if (containers.empty()) return;
    Json& container = *anyOf(containers, random);
    const Json sibling = anyOf(container, random);
    const auto target = std::next(container.begin(), static_cast<std::ptrdiff_t>(below(container.size(), random)));
    switch (below(6, random))
    {
    case 0:
        container.erase(target);
        break;
    case 1:
        if (container.is_array()) container.push_back(sibling);
        break;
    default:
        replace(*target, sibling, random);
    }
}

} // namespace

void importOnce(const std::uint8_t* data, std::size_t size, const std::string& fileName)
{
    osg::setNotifyLevel(osg::ALWAYS);
    ImportOptions options;
    options.maxDecodedBytes = std::size_t(16) << 20;
    options.maxElements = std::size_t(1) << 16;
    const auto model = importModel(std::string(reinterpret_cast<const char*>(data), size), fileName, options);
    if (model) model.value().root->getBound();
}

std::optional<std::string> mutateDocument(const std::string& text, std::minstd_rand& random)
{
    if (isDeep(text)) return std::nullopt;
    Json document = Json::parse(text, nullptr, false);
    if (document.is_discarded()) return std::nullopt;
    change(document, random);
    return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void mutateBytes(std::string& bytes, std::size_t most)
{
    const std::size_t size = bytes.size();
    bytes.resize(most);
    bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, most));
}

std::size_t mutate(std::uint8_t* data, std::size_t size, std::size_t most, unsigned int seed,
                   const std::function<std::optional<std::string>(const std::string&, std::minstd_rand&)>& change)
{
    std::minstd_rand random(seed);
    if (random() % 4 == 0) return LLVMFuzzerMutate(data, size, most);
    const auto changed = change(std::string(reinterpret_cast<const char*>(data), size), random);
    if (!changed || changed->size() > most) return LLVMFuzzerMutate(data, size, most);
    std::copy(changed->begin(), changed->end(), data);
    return changed->size();
}

} // namespace osgGpuAnimation::gltf
