// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <utility>

namespace osgGpuAnimation::gltf
{

/// The element with a number that the validation has checked. glTF's numbers, like a node's mesh, are ints, so that -1
/// is none, which has no element.
template <typename List>
decltype(auto) elementOf(List&& list, int number)
{
    assert(number >= 0 && "none has no element");
    return std::forward<List>(list)[static_cast<std::size_t>(number)];
}

template <typename List, typename Number>
void elementOf(List&&, Number) = delete; // no cast is needed

template <typename List, typename Value>
bool contains(const List& list, const Value& value)
{
    return std::find(std::begin(list), std::end(list), value) != std::end(list);
}

} // namespace osgGpuAnimation::gltf
