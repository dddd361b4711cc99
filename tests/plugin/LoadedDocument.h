// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/LoadDocument.h"
#include "plugin/ModelBuilder.h"

#include <nlohmann/json.hpp>

#include <string>

namespace osgGpuAnimation::gltf
{

// A small valid document that tests change, and the result of loadDocument().

/// The accessors of the base document.
enum BaseAccessor
{
    positions,
    normals,
    joints,
    weights,
    slideTimes,
    slideValues,
    turnTimes,
    turnValues,
    inverseBinds,
    baseAccessors ///< how many there are
};

/// Its nodes: body is the skinned mesh, hip the parent of knee.
enum BaseNode
{
    hip,
    knee,
    body
};

/// A skinned triangle with two joints and one animation of two channels.
ModelBuilder baseModel();
/// The same as JSON, with a material, a texture, a sampler and a picture.
nlohmann::json baseDocument();

/// The result of loading a document.
struct LoadedDocument
{
    Result<tinygltf::Model> model;
    Messages messages;

    /// "loaded" or "refused: …", and all warnings.
    std::string text() const;
};

LoadedDocument load(const std::string& bytes, const std::string& fileName = "", const ImportOptions& options = {});

enum class Expect
{
    Valid, ///< no warning
    Warn,
    Refuse
};

/// Adds failures to the running test if the answer is another one or its text lacks the message.
void expectAnswer(const LoadedDocument& answer, Expect expect, const std::string& message);

} // namespace osgGpuAnimation::gltf
