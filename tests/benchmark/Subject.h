// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <string>

namespace osgGpuAnimation::benchmark
{

/// A character to measure: an imported file and the clip to play.
struct Subject
{
    std::string name; ///< of the file, without its extension
    std::string fileName;
    gltf::ImportedModel model;
    std::size_t clip = 0; ///< the clip that moves the most joints; the first one of several

    const AnimationSet& set() const { return *model.set; }
    std::size_t jointCount() const { return set().skeleton().jointCount(); }
};

/// fixedLighting: with the fixed pipeline's look, as osgAnimation draws. compact: see gltf::ImportOptions; 0: exact.
/// Errors: those of the import; no clip of the file moves anything.
Result<Subject> loadSubject(const std::string& fileName, bool fixedLighting, double compact = 0.0);

/// True if a property of the joint changes in the clip or differs from the rest pose.
/// part: JointTransform::translation, rotation or scale.
bool isDriven(const AnimationSet& set, const Clip& clip, std::size_t joint, glm::vec4 JointTransform::*part);

/// The start time of character i of a crowd within its clip: seconds in [0, duration), the same in every run.
double phaseOf(std::size_t character, double duration);

} // namespace osgGpuAnimation::benchmark
