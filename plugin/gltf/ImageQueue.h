// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/EncodedImage.h"

#include <atomic>
#include <future>
#include <map>
#include <thread>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Decodes pictures one after the other on a thread of its own, while the importer reads clips and meshes: decoding is
/// a good part of the time that a load takes.
class ImageQueue
{
public:
    using Decoded = Result<osg::ref_ptr<osg::Image>>;

    /// The images to decode, under the caller's numbers; their bytes must outlive the queue.
    explicit ImageQueue(const std::map<int, EncodedImage>& images);
    /// Does not wait for pictures that were not begun.
    ~ImageQueue();

    /// Waits for one of the images; to be called once for each.
    Decoded take(int number) { return _decoded.at(number).get(); }

private:
    void run();

    std::vector<std::pair<EncodedImage, std::promise<Decoded>>> _tasks;
    std::map<int, std::future<Decoded>> _decoded;
    std::atomic<bool> _stop{false};
    std::thread _thread;
};

} // namespace osgGpuAnimation::gltf
