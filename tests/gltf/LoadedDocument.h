// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/LoadDocument.h"
#include "gltf/ModelBuilder.h"

#include <nlohmann/json.hpp>

#include <string>

namespace osgGpuAnimation::gltf
{

// A small valid document that tests change, and the result of loadDocument().

/// The accessor of the base document's positions; others follow.
constexpr int positions = 0;

/// The base document's nodes: body is the skinned mesh, hip the parent of knee.
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
/// The base document with optional parts: a still copy of its mesh, one of three lights at each of the first nodes, two
/// cameras, and the materials "own", "red" and "golden". Both meshes are red in variant 1 and golden in variants 2 and
/// 3, of which the last has the name of the first.
nlohmann::json richDocument();

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
