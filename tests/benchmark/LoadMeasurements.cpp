// SPDX-License-Identifier: MIT
#include "Measurements.h"

#include "gltf/file/ModelBytes.h"

#include <tiny_gltf.h>

namespace osgGpuAnimation::benchmark
{

void measureLoad(const Subject& subject, Run& run)
{
    // From the file name to the OSG graph that is ready to be drawn.
    const auto loadOurs = [&]
    {
        const Stopwatch stopwatch;
        const std::string bytes = taken(gltf::readModelFile(subject.fileName, {}));
        const gltf::ImportedModel model = taken(gltf::importModel(bytes, subject.fileName, {}));
        return stopwatch.elapsed();
    };
    // Parsing and image decoding alone, with tinygltf's defaults.
    const auto loadByTinyGltf = [&]
    {
        const Stopwatch stopwatch;
        tinygltf::TinyGLTF loader;
        tinygltf::Model model;
        std::string error, warning;
        const bool isLoaded = loader.LoadBinaryFromFile(&model, &error, &warning, subject.fileName);
        const Spent spent = stopwatch.elapsed();
        if (!isLoaded) throw std::runtime_error("tinygltf: " + error);
        return spent;
    };
    const std::vector<Series> series = interleaved(run.loadRounds, {loadOurs, loadByTinyGltf});
    run.report.add(Row(subject.name, 1, "load, from the file to the OSG graph", "ms", series[0], 1e3)
                       .against("tinygltf's parse and image decode alone", series[1])
                       .atMost(1.5));
}

} // namespace osgGpuAnimation::benchmark
