// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <string>

namespace osgGpuAnimation::benchmark
{

/// A character to measure with: an imported file and the clip that is played.
struct Subject
{
    std::string name;
    std::string fileName;
    gltf::ImportedModel model;
    std::size_t clip = 0; ///< the one that moves the most joints; of several, the first

    const AnimationSet& set() const { return *model.set; }
    std::size_t jointCount() const { return set().skeleton().jointCount(); }
    std::size_t vertexCount() const; ///< of all its meshes
};

/// Errors: those of the import; nothing in the file moves.
Result<Subject> loadSubject(const std::string& name, const std::string& fileName);

/// Does a property of a joint change in a clip, or differ from the rest pose?
/// part: JointTransform::translation, rotation or scale.
bool isDriven(const AnimationSet& set, const Clip& clip, std::size_t joint, glm::vec4 JointTransform::*part);

/// When character i of a crowd starts within its clip: seconds in [0, duration), the same in every run.
double phaseOf(std::size_t character, double duration);

} // namespace osgGpuAnimation::benchmark
