// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// A dense array in blocks, of which frames take snapshots: a change after a snapshot copies its block alone, so what
/// does not change costs nothing, and a block that two snapshots have has not changed.
///
/// Several threads may take snapshots at the same time, but not while elements change.
template <typename Element>
class SharedBlocks
{
public:
    static constexpr std::size_t blockSize = 256; ///< elements of a block
    using Block = std::array<Element, blockSize>;
    using Blocks = std::vector<std::shared_ptr<const Block>>; ///< the last one may be partly used
    using Snapshot = std::shared_ptr<const Blocks>;           ///< the same one until an element changes

    SharedBlocks() = default;
    SharedBlocks(const SharedBlocks& other)
        : _size(other._size), _blocks(other._blocks), _ofSnapshot(_blocks.size(), 0), _snapshots(1)
    {
        other.snapshot(); // of the blocks that both have now
    }
    SharedBlocks& operator=(const SharedBlocks&) = delete;

    std::size_t size() const { return _size; }
    const Element& operator[](std::size_t index) const { return (*_blocks[index / blockSize])[index % blockSize]; }
    void set(std::size_t index, const Element& element)
    {
        _latest.reset();
        const std::size_t number = index / blockSize;
        if (_ofSnapshot[number] != _snapshots)
        {
            _blocks[number] = std::make_shared<Block>(*_blocks[number]);
            _ofSnapshot[number] = _snapshots;
        }
        (*_blocks[number])[index % blockSize] = element;
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
        _latest.reset();
        --_size;
        if (_size % blockSize != 0) return;
        _blocks.pop_back();
        _ofSnapshot.pop_back();
    }

    Snapshot snapshot() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (!_latest)
        {
            ++_snapshots;
            _latest = std::make_shared<const Blocks>(_blocks.begin(), _blocks.end());
        }
        return _latest;
    }

private:
    std::size_t _size = 0;
    std::vector<std::shared_ptr<Block>> _blocks;
    std::vector<std::uint64_t> _ofSnapshot; ///< by block: the number of snapshots before it was copied
    mutable std::uint64_t _snapshots = 0;
    mutable Snapshot _latest; ///< null: an element has changed since
    mutable std::mutex _mutex;
};

} // namespace osgGpuAnimation
