// SPDX-License-Identifier: MIT
#include "tool/InspectCommand.h"

#include "gltf/file/ProgressLine.h"
#include "tool/ModelFile.h"
#include "tool/ModelReport.h"

#include <iostream>

namespace osgGpuAnimation::tool
{

Result<void> InspectCommand::run() const
{
    const Result<gltf::ImportOptions> given = importOptions(clips, clipJoints);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    options.noRotation = true;
    if (compact > 0.0) options.compact = compact;
    const Result<gltf::ImportedModel> model = readModel(file, options);
    if (!model) return Error{file + ": " + model.error().message};
    nlohmann::ordered_json report;
    {
        const gltf::ProgressLine progress("inspecting");
        report = reportModel(model.value(), file);
    }
    // Names in a file may hold any bytes; those that are not UTF-8 are replaced.
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    std::cout << (json ? report.dump(2, ' ', false, replace) + "\n" : reportText(report)) << std::flush;
    if (!std::cout) return Error{"standard output: cannot be written"};
    return {};
}

} // namespace osgGpuAnimation::tool
