// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/MaterialDescription.h"
#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"
#include "gltf/import/Cameras.h"
#include "gltf/import/Lights.h"
#include "gltf/import/SceneGraph.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The result of an import.
struct ImportedModel
{
    osg::Matrixd fileToNode;       ///< from +Y up to +Z up (identity with noRotation)
    osg::ref_ptr<osg::Group> root; ///< in OSG's axes
    /// Below root; null where nothing in the file can move. Its name is the file's without folder and extension, or
    /// the scene's for streams.
    osg::ref_ptr<AnimatedCharacter> character;
    std::shared_ptr<const AnimationSet> set;   ///< the character's; null without a character
    std::vector<ImportedPrimitive> primitives; ///< by node, then primitive
    std::vector<ImportedLight> lights;         ///< by node; empty with noLights
    std::vector<ImportedCamera> cameras;       ///< by node; empty with noCameras
    osg::ref_ptr<osg::CameraView> startCamera; ///< the one that the options name; null: none

    int scene = 0;                               ///< the imported scene, -1: the file has none
    std::vector<std::string> nodeNames;          ///< one per node of the file; empty if it has none
    std::vector<int> nodeParents;                ///< -1 for roots
    std::optional<CompactedCharacter> compacted; ///< only if the options ask for compact clips
    /// The file's animation number of each clip of the set; the clips of other files have the numbers after them.
    std::vector<int> animationOfClip;
    std::vector<MaterialDescription> materials;
    std::vector<std::string> variantNames; ///< of KHR_materials_variants, each different
    std::vector<std::string> extensionsUsed;
    std::string generator; ///< asset.generator
    Messages messages;
};

/// Imports a file's content; see loadDocument() for bytes and fileName.
/// Errors: those of loadDocument(); the options name a clip, scene, variant or camera that the file does not have.
/// outOfFailure: the messages before an error, which may explain it.
Result<ImportedModel> importModel(const std::string& bytes, const std::string& fileName, const ImportOptions& options,
                                  Messages* outOfFailure = nullptr);

} // namespace osgGpuAnimation::gltf
