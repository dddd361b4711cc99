// SPDX-License-Identifier: MIT
#include "Measurements.h"

#include "gltf/file/ModelBytes.h"

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr double milliseconds = 1e3;

/// From the file name to the OSG graph that is ready to be drawn.
std::optional<Error> loadOurs(const std::string& fileName, Spent& spent)
{
    const Stopwatch stopwatch;
    const Result<std::string> bytes = gltf::readModelFile(fileName, {});
    if (!bytes) return bytes.error();
    const Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), fileName, {});
    spent = stopwatch.elapsed();
    return model ? std::nullopt : std::optional<Error>(model.error());
}

/// Parsing and image decoding alone, with tinygltf's defaults.
std::optional<Error> loadByTinyGltf(const std::string& fileName, Spent& spent)
{
    const Stopwatch stopwatch;
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    const bool isLoaded = loader.LoadBinaryFromFile(&model, &error, &warning, fileName);
    spent = stopwatch.elapsed();
    return isLoaded ? std::nullopt : std::optional<Error>(Error{"tinygltf: " + error});
}

} // namespace

Result<void> measureLoad(const Subject& subject, const Effort& effort, Report& report)
{
    std::optional<Error> error;
    const auto timed = [&](std::optional<Error> (*load)(const std::string&, Spent&))
    {
        Spent spent;
        if (std::optional<Error> found = load(subject.fileName, spent)) error = std::move(found);
        return spent;
    };
    const std::vector<Series> series =
        interleaved(effort.loadRounds, {[&] { return timed(loadOurs); }, [&] { return timed(loadByTinyGltf); }});
    if (error) return *error;
    Row row = compared(series[0], series[1], milliseconds, false);
    row.subject = subject.name;
    row.count = 1;
    row.what = "load, from the file to the OSG graph";
    row.unit = "ms";
    row.otherName = "tinygltf's parse and image decode alone";
    row.bar = "≤ 1.5";
    row.isMet = row.ratio.median <= 1.5;
    report.add(std::move(row));
    return {};
}

} // namespace osgGpuAnimation::benchmark
