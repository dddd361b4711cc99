// SPDX-License-Identifier: MIT
#include "gltf/ImageQueue.h"

#include <exception>
#include <system_error>

namespace osgGpuAnimation::gltf
{

ImageQueue::ImageQueue(const std::map<int, EncodedImage>& images)
{
    for (const auto& [number, image] : images)
    {
        _tasks.emplace_back(image, std::promise<Decoded>());
        _decoded.emplace(number, _tasks.back().second.get_future());
    }
    if (_tasks.empty()) return;
    try
    {
        _thread = std::thread(&ImageQueue::run, this);
    }
    catch (const std::system_error&)
    {
        run(); // no more threads are to be had: at once, then
    }
}

ImageQueue::~ImageQueue()
{
    _stop = true;
    if (_thread.joinable()) _thread.join();
}

void ImageQueue::run()
{
    for (auto& [image, promise] : _tasks)
    {
        if (_stop) return;
        try
        {
            promise.set_value(image.decode());
        }
        catch (...)
        {
            promise.set_exception(std::current_exception()); // out of memory: thrown again where it is taken
        }
    }
}

} // namespace osgGpuAnimation::gltf
