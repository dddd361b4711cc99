// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

/// The model of the file's text. If the import refuses it, the test fails and the model is empty.
inline ImportedModel imported(const ModelBuilder& file, const ImportOptions& options = {})
{
    const Result<ImportedModel> model = importModel(file.text(), "", options);
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value() : ImportedModel{};
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
