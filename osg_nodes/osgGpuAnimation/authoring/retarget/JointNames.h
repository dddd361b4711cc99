// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The part of a joint's name after namespaces and Mixamo's prefix, which differ from file to file: "Hips" of "Hips",
/// "mixamorig:Hips", "mixamorig4_Hips", "mixamorigHips" and "Armature|hero:Hips".
std::string bareJointName(const std::string& name);

/// bareJointName() in small letters, with `_` for dots, which exporters replace.
std::string caselessJointName(const std::string& name);

/// The names of joints, morphs and other elements that have one.
template <typename T>
std::vector<std::string> namesIn(const std::vector<T>& elements)
{
    std::vector<std::string> names;
    for (const T& element : elements)
        names.push_back(elementName(element));
    return names;
}

/// Finds the counterparts of joints by name. One per name: an index of `others`, -1 where there is none.
///
/// A name of `given` has the counterpart that `given` names, or none where that is empty. Other names have the joint of
/// the same name, else of the same bareJointName(), else of the same caselessJointName() if no name before has it. Of
/// several joints with one name, the n-th has the n-th as its counterpart, and the first one where there are fewer.
/// Empty names have no counterpart.
std::vector<int> findCounterparts(const std::vector<std::string>& names, const std::vector<std::string>& others,
                                  const std::map<std::string, std::string>& given);

/// The joints of known human rigs: Mixamo, CMU's motion capture as BVH, Unreal's mannequin, VRM (its own names and
/// VRoid's) and the deform bones of Rigify. Joints of two of them have the same role if they move the same part of the
/// body: `LeftForeArm` of Mixamo has the role of `lowerarm_l` of Unreal.
///
///     std::vector<int> found = RigNames::counterparts({"Hips", "Spine", …}, {"pelvis", "spine_01", …});
namespace RigNames
{

/// A skeleton with fewer names of a rig has another one: half a body must not move without the other half.
constexpr std::size_t minNames = 12;

/// One per name: the index of the other name with the same role; -1: none, or one of the skeletons is of no known rig.
/// The rig of a skeleton is the one of which it has the most names, without namespaces and regard to case.
std::vector<int> counterparts(const std::vector<std::string>& names, const std::vector<std::string>& others);

/// Completes the result of findCounterparts(): a name without a counterpart that `given` does not have gets that of its
/// role, unless another name has it.
void addCounterparts(const std::vector<std::string>& names, const std::vector<std::string>& others,
                     const std::map<std::string, std::string>& given, std::vector<int>& counterparts);

} // namespace RigNames

} // namespace osgGpuAnimation
