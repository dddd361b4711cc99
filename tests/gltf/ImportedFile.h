// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/GlbText.h"
#include "gltf/Import.h"
#include "gltf/ModelBuilder.h"
#include "support/Results.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The model of a file's content. If the import refuses it, the test ends as a failure.
inline ImportedModel imported(const std::string& content, const ImportOptions& options = {},
                              const std::string& fileName = "")
{
    ImportedModel model = valueOf(importModel(content, fileName, options));
    keepSeed(content);
    return model;
}

inline ImportedModel imported(const ModelBuilder& file, const ImportOptions& options = {})
{
    return imported(file.text(), options);
}

/// Expects these warnings, or a part of each, in this order and no others.
inline void expectWarnings(const ImportedModel& model, const std::vector<std::string>& parts)
{
    const std::vector<std::string>& warnings = model.messages.warnings;
    EXPECT_EQ(warnings.size(), parts.size());
    for (std::size_t i = 0; i < warnings.size(); ++i)
        EXPECT_NE(warnings[i].find(i < parts.size() ? parts[i] : "no more warnings"), std::string::npos) << warnings[i];
}

/// Expects that the import refuses a file's content with this error, or a part of it.
inline void expectRefused(const std::string& content, const std::string& message, const ImportOptions& options = {})
{
    EXPECT_TRUE(hasError(importModel(content, "", options), message));
}

/// The first primitive of the file's node. The test fails if the graph has none.
inline const ImportedPrimitive& primitiveOf(const ImportedModel& model, int node)
{
    for (const ImportedPrimitive& primitive : model.primitives)
        if (primitive.node == node) return primitive;
    ADD_FAILURE() << "nothing of node " << node << " came into the graph";
    return model.primitives.front();
}

} // namespace osgGpuAnimation::gltf
