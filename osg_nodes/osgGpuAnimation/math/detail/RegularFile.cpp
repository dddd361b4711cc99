// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/RegularFile.h>

#include <utility>

namespace osgGpuAnimation
{

Result<std::string> RegularFile::readWhole(const std::string& path, std::uint64_t maxBytes)
{
    const Result<RegularFile> file = open(path);
    if (!file) return file.error();
    return file.value().readWhole(maxBytes);
}

RegularFile::RegularFile(RegularFile&& other) noexcept : _handle(std::exchange(other._handle, none)), _size(other._size)
{
}

Result<std::size_t> RegularFile::read(void* to, std::size_t bytes) const
{
    std::size_t done = 0;
    while (done < bytes)
    {
        const Result<std::size_t> count = readSome(done, static_cast<char*>(to) + done, bytes - done);
        if (!count) return count.error();
        if (count.value() == 0)
            return Error{"expected " + std::to_string(bytes) + " bytes, found " + std::to_string(done)};
        done += count.value();
    }
    return done;
}

Result<std::string> RegularFile::readWhole(std::uint64_t maxBytes) const
{
    if (_size == 0) return Error{"the file is empty"};
    std::string content;
    // A sparse file can be far larger than its disk.
    if (_size > maxBytes || _size > content.max_size())
        return Error{"expected a file of at most " + std::to_string(maxBytes) + " bytes, found " +
                     std::to_string(_size)};
    content.resize(_size);
    const Result<std::size_t> done = read(content.data(), content.size());
    if (!done) return done.error();
    return content;
}

} // namespace osgGpuAnimation
