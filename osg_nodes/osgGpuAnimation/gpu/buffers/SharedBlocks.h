// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// A dense array in blocks, of which frames take snapshots: a change after a snapshot copies its block alone, so what
/// does not change costs nothing, and a block's serial tells whether a buffer on the GPU has its content.
///
/// Several threads may take snapshots at the same time, but not while elements change.
template <typename Element>
class SharedBlocks
{
public:
    static constexpr std::size_t blockSize = 256; ///< elements of a block
    struct Block
    {
        std::uint64_t serial = 0; ///< another one after each change; not reused in this array
        std::array<Element, blockSize> elements;
    };
    using Snapshot = std::vector<std::shared_ptr<const Block>>; ///< the last block may be partly used

    SharedBlocks() = default;
    SharedBlocks(const SharedBlocks& other) : _size(other._size), _blocks(other._blocks), _serial(other._serial)
    {
        other._snapshots.fetch_add(1);
        _snapshots = 1;
        _ofSnapshot.assign(_blocks.size(), 0);
    }
    SharedBlocks& operator=(const SharedBlocks&) = delete;

    std::size_t size() const { return _size; }
    const Element& operator[](std::size_t index) const
    {
        return _blocks[index / blockSize]->elements[index % blockSize];
    }
    void set(std::size_t index, const Element& element)
    {
        const std::size_t number = index / blockSize;
        if (_ofSnapshot[number] != _snapshots)
        {
            _blocks[number] = std::make_shared<Block>(*_blocks[number]);
            _ofSnapshot[number] = _snapshots;
        }
        _blocks[number]->elements[index % blockSize] = element;
        _blocks[number]->serial = ++_serial;
    }
    void add(const Element& element)
    {
        if (_size == _blocks.size() * blockSize)
        {
            _blocks.push_back(std::make_shared<Block>());
            _ofSnapshot.push_back(_snapshots);
        }
        set(_size++, element);
    }
    /// Removes an element by moving the last one to its place.
    void remove(std::size_t index)
    {
        if (index + 1 != _size) set(index, (*this)[_size - 1]);
        --_size;
        if (_size % blockSize != 0) return;
        _blocks.pop_back();
        _ofSnapshot.pop_back();
    }

    Snapshot snapshot() const
    {
        ++_snapshots;
        return {_blocks.begin(), _blocks.end()};
    }

private:
    std::size_t _size = 0;
    std::vector<std::shared_ptr<Block>> _blocks;
    std::vector<std::uint64_t> _ofSnapshot; ///< by block: the number of snapshots before it was copied
    mutable std::atomic<std::uint64_t> _snapshots{0};
    std::uint64_t _serial = 0;
};

} // namespace osgGpuAnimation
