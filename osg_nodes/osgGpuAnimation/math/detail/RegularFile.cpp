// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/RegularFile.h>
#include <osgGpuAnimation/math/detail/System.h>

#include <utility>

namespace osgGpuAnimation
{

Result<RegularFile> RegularFile::open(const std::string& path)
{
    const Result<system::File> file = system::openRegularFile(path);
    if (!file) return file.error();
    return RegularFile(file.value().handle, static_cast<std::size_t>(file.value().size));
}

Result<std::string> RegularFile::readWhole(const std::string& path, std::uint64_t maxBytes)
{
    const Result<RegularFile> file = open(path);
    if (!file) return file.error();
    return file.value().readWhole(maxBytes);
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : _handle(std::exchange(other._handle, system::File::none)), _size(other._size)
{
}

RegularFile::~RegularFile()
{
    if (_handle != system::File::none) system::closeFile(_handle);
}

bool RegularFile::isSameAs(const std::string& path) const
{
    return system::isSameFile(_handle, path);
}

Result<std::size_t> RegularFile::read(void* to, std::size_t bytes) const
{
    std::size_t done = 0;
    while (done < bytes)
    {
        const Result<std::size_t> count = system::readFile(_handle, done, static_cast<char*>(to) + done, bytes - done);
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
