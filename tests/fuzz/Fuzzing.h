// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>

namespace osgGpuAnimation::gltf
{

/// Imports one input up to the finished OSG graph and its bounds, within limits that keep a fuzzer fast. fileName: the
/// assumed location of the input; empty: no external files.
void importOnce(const std::uint8_t* data, std::size_t size, const std::string& fileName);

/// Changes one value of a JSON document and keeps it valid JSON, which random bytes rarely do: replaces a number,
/// removes or duplicates a member, or replaces one member by another. Nothing if the text is not JSON.
std::optional<std::string> mutateDocument(const std::string& text, std::minstd_rand& random);

/// Changes bytes as libFuzzer does.
void mutateBytes(std::string& bytes, std::size_t most);

/// A custom mutator of libFuzzer: three of four mutations are those of `change`, unless it returns nothing.
std::size_t mutate(std::uint8_t* data, std::size_t size, std::size_t most, unsigned int seed,
                   const std::function<std::optional<std::string>(const std::string&, std::minstd_rand&)>& change);

} // namespace osgGpuAnimation::gltf
