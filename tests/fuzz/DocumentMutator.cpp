// SPDX-License-Identifier: MIT
#include "fuzz/DocumentMutator.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

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

class Mutator
{
public:
    explicit Mutator(std::minstd_rand& random) : _random(random) {}

    void run(Json& document);

private:
    std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(_random); }
    void change(Json& container);
    void replace(Json& value, const Json& sibling);

    std::minstd_rand& _random;
};

void Mutator::run(Json& document)
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
    if (!containers.empty()) change(*containers[below(containers.size())]);
}

void Mutator::change(Json& container)
{
    const auto place = [&]
    { return std::next(container.begin(), static_cast<std::ptrdiff_t>(below(container.size()))); };
    const Json sibling = *place();
    const auto target = place();
    switch (below(6))
    {
    case 0:
        container.erase(target);
        break;
    case 1:
        if (container.is_array()) container.push_back(sibling);
        break;
    default:
        replace(*target, sibling);
    }
}

void Mutator::replace(Json& value, const Json& sibling)
{
    if (value.is_number_integer() && below(2) == 0)
        value = static_cast<std::int64_t>(value.get<std::uint64_t>() + below(5) - 2); // wraps round
    else if (below(4) == 0)
        value = sibling;
    else if (value.is_number() || below(2) == 0)
        value = numbers[below(std::size(numbers))];
    else
        value = others[below(std::size(others))];
}

} // namespace

std::optional<std::string> mutateDocument(const std::string& text, std::minstd_rand& random)
{
    if (isDeep(text)) return std::nullopt;
    Json document = Json::parse(text, nullptr, false);
    if (document.is_discarded()) return std::nullopt;
    Mutator(random).run(document);
    return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace osgGpuAnimation::gltf
