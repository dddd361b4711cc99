// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"
#include "plugin/SharedAssets.h"

#include <gtest/gtest.h>

#include <string>

namespace osgGpuAnimation::gltf
{

/// Imports the model of that modelFile() name. Skips the test where the file is missing, and fails it where the import
/// does: a SetUp() goes on only if it is neither IsSkipped() nor HasFatalFailure().
inline void importOrSkip(const std::string& name, ImportedModel& outModel)
{
    const std::string file = modelFile(name);
    if (file.empty()) GTEST_SKIP() << "there is no " << name;
    const Result<ImportedModel> imported = importModel(readBytes(file), file, {});
    ASSERT_TRUE(imported) << imported.error().message;
    outModel = imported.value();
}

} // namespace osgGpuAnimation::gltf
