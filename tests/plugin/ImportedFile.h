// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

/// The model in the file's text. A failure of the test, and an empty model, where it is refused.
inline ImportedModel imported(const ModelBuilder& file, const ImportOptions& options = {})
{
    const Result<ImportedModel> model = importModel(file.text(), "", options);
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value() : ImportedModel{};
}

/// The first primitive of the file's node. A failure of the test where none is in the graph.
inline const ImportedPrimitive& primitiveOf(const ImportedModel& model, int node)
{
    for (const ImportedPrimitive& primitive : model.primitives)
        if (primitive.node == node) return primitive;
    ADD_FAILURE() << "nothing of node " << node << " came into the graph";
    return model.primitives.front();
}

} // namespace osgGpuAnimation::gltf
