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
inline void importOrSkip(const std::string& name, ImportedModel& outModel, const ImportOptions& options = {})
{
    const std::string file = modelFile(name);
    if (file.empty()) GTEST_SKIP() << "there is no " << name;
    const Result<ImportedModel> imported = importModel(readBytes(file), file, options);
    ASSERT_TRUE(imported) << imported.error().message;
    outModel = imported.value();
}

/// Names a test's parameter after its file: Fox of assets/Fox/Fox.glb. For INSTANTIATE_TEST_SUITE_P.
inline std::string nameOfFile(const std::string& file)
{
    const std::size_t begin = file.find_last_of('/') + 1;
    return file.substr(begin, file.find('.', begin) - begin);
}

} // namespace osgGpuAnimation::gltf
