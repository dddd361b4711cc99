// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/RetargetOptions.h>

#include <tiny_gltf.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The consequence for a file of clips that cannot be added, see Report::unmet().
constexpr const char* leftOutText = "its clips are left out";

/// The clips of another file, see ImportOptions::clipsFiles.
struct ClipFile
{
    std::string name;                        ///< for messages: `clips "General.glb"`
    std::shared_ptr<const AnimationSet> set; ///< its joints, morphs and clips, without skins; at least one clip
};

/// Joints whose names differ between the model and the files of clips, see ImportOptions::clipJoints.
struct ClipJoints
{
    std::string name; ///< for messages: `clipJoints "names.json"`
    /// From joints of the model, as bareJointName() has them, to their counterparts; an empty one: there is none.
    std::map<std::string, std::string> counterparts;
};

/// Reads the names that the options give: a JSON object whose members are joints of the model, with their counterparts
/// in the files of clips, null or "" where there shall be none. A fault costs the file or its member, with a warning.
ClipJoints readClipJoints(const std::string& modelFile, const ImportOptions& options, Report& report);

/// Warns of names that are neither the model's nor those of any file.
void warnOfUnknownJoints(const ClipJoints& joints, const Skeleton& model, const std::vector<ClipFile>& files,
                         Report& report);

/// Reads the clips of all files that the options name; files without meshes are valid. Files that are no glTF need
/// options.otherFormats. A file that cannot be read, has no clips, or is named twice, is left out with a warning.
///
/// A clip without a name, or with a generic one (see isGenericClipName()), is named after its file.
///
/// modelFile: the model's own file, see ModelFolder; the clips of that file itself are refused.
/// target: the model that the clips are for. Its objects have the animated properties of the file's objects of the same
/// name, or number where they have no names. Null: by number alone.
std::vector<ClipFile> readClipFiles(const std::string& modelFile, const ImportOptions& options, Report& report,
                                    const tinygltf::Model* target = nullptr);

/// One per node of the model: true if a clip of those files moves a joint of its name, or its counterpart.
std::vector<bool> nodesMovedBy(const std::vector<ClipFile>& files, const ClipJoints& joints,
                               const tinygltf::Model& model);

/// The set with the clips of the file after its own, at least one, see osgGpuAnimation::withClipsOf(). Errors, which
/// begin with the name of the file: those of that function; the clips exceed the budget; none can be played. Warnings:
/// a clip that takes a joint too far is left out; the joints without a counterpart, those of the set only if skins name
/// them. A given counterpart that the file does not have is ignored. A note says how many joints with another rest pose
/// were matched in which way, if `match` leaves the choice.
Result<std::shared_ptr<const AnimationSet>> withClipsOf(const std::shared_ptr<const AnimationSet>& set,
                                                        const ClipFile& file, const ClipJoints& joints, ClipMatch match,
                                                        MemoryBudget& budget, Report& report);

} // namespace osgGpuAnimation::gltf
