// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/retarget/RigNames.h>

#include <osgGpuAnimation/authoring/retarget/JointNames.h>

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t rigCount = 6;

/// The sides that replace `?`, left and right.
constexpr const char* sides[rigCount][2] = {{"left", "right"}, {"left", "right"}, {"l", "r"},
                                            {"left", "right"}, {"l", "r"},        {"l", "r"}};

/// A role in each rig, as caselessJointName() has the names; empty: the rig has no such joint.
constexpr const char* roles[][rigCount] = {
    // Mixamo, CMU's BVH, Unreal, VRM, VRoid, Rigify
    {"hips", "hips", "pelvis", "hips", "j_bip_c_hips", "def-spine"},
    {"spine", "lowerback", "spine_01", "spine", "j_bip_c_spine", "def-spine.001"},
    {"spine1", "spine", "spine_02", "chest", "j_bip_c_chest", "def-spine.002"},
    {"spine2", "spine1", "spine_03", "upperchest", "j_bip_c_upperchest", "def-spine.003"},
    {"neck", "neck", "neck_01", "neck", "j_bip_c_neck", "def-spine.004"},
    {"head", "head", "head", "head", "j_bip_c_head", "def-spine.006"},
    {"?shoulder", "?shoulder", "clavicle_?", "?shoulder", "j_bip_?_shoulder", "def-shoulder.?"},
    {"?arm", "?arm", "upperarm_?", "?upperarm", "j_bip_?_upperarm", "def-upper_arm.?"},
    {"?forearm", "?forearm", "lowerarm_?", "?lowerarm", "j_bip_?_lowerarm", "def-forearm.?"},
    {"?hand", "?hand", "hand_?", "?hand", "j_bip_?_hand", "def-hand.?"},
    {"?upleg", "?upleg", "thigh_?", "?upperleg", "j_bip_?_upperleg", "def-thigh.?"},
    {"?leg", "?leg", "calf_?", "?lowerleg", "j_bip_?_lowerleg", "def-shin.?"},
    {"?foot", "?foot", "foot_?", "?foot", "j_bip_?_foot", "def-foot.?"},
    {"?toebase", "?toebase", "ball_?", "?toes", "j_bip_?_toebase", "def-toe.?"},
    {"?handthumb1", "", "thumb_01_?", "?thumbproximal", "j_bip_?_thumb1", "def-thumb.01.?"},
    {"?handthumb2", "", "thumb_02_?", "?thumbintermediate", "j_bip_?_thumb2", "def-thumb.02.?"},
    {"?handthumb3", "", "thumb_03_?", "?thumbdistal", "j_bip_?_thumb3", "def-thumb.03.?"},
    {"?handindex1", "", "index_01_?", "?indexproximal", "j_bip_?_index1", "def-f_index.01.?"},
    {"?handindex2", "", "index_02_?", "?indexintermediate", "j_bip_?_index2", "def-f_index.02.?"},
    {"?handindex3", "", "index_03_?", "?indexdistal", "j_bip_?_index3", "def-f_index.03.?"},
    {"?handmiddle1", "", "middle_01_?", "?middleproximal", "j_bip_?_middle1", "def-f_middle.01.?"},
    {"?handmiddle2", "", "middle_02_?", "?middleintermediate", "j_bip_?_middle2", "def-f_middle.02.?"},
    {"?handmiddle3", "", "middle_03_?", "?middledistal", "j_bip_?_middle3", "def-f_middle.03.?"},
    {"?handring1", "", "ring_01_?", "?ringproximal", "j_bip_?_ring1", "def-f_ring.01.?"},
    {"?handring2", "", "ring_02_?", "?ringintermediate", "j_bip_?_ring2", "def-f_ring.02.?"},
    {"?handring3", "", "ring_03_?", "?ringdistal", "j_bip_?_ring3", "def-f_ring.03.?"},
    {"?handpinky1", "", "pinky_01_?", "?littleproximal", "j_bip_?_little1", "def-f_pinky.01.?"},
    {"?handpinky2", "", "pinky_02_?", "?littleintermediate", "j_bip_?_little2", "def-f_pinky.02.?"},
    {"?handpinky3", "", "pinky_03_?", "?littledistal", "j_bip_?_little3", "def-f_pinky.03.?"},
};

/// By name: the role, twice its row and one more for the right side.
using RoleOfName = std::unordered_map<std::string, int>;

RoleOfName rolesOf(std::size_t rig)
{
    RoleOfName result;
    for (std::size_t row = 0; row < std::size(roles); ++row)
        for (const bool isRight : {false, true})
        {
            std::string name = roles[row][rig];
            const std::size_t side = name.find('?');
            if (side != std::string::npos) name.replace(side, 1, sides[rig][isRight ? 1 : 0]);
            if (!name.empty() && (side != std::string::npos || !isRight))
                result[name] = static_cast<int>(2 * row + (isRight ? 1 : 0));
        }
    return result;
}

/// One role per name of a skeleton; -1: none. Empty: the skeleton is of no known rig.
std::vector<int> rolesOf(const std::vector<std::string>& names)
{
    static const std::vector<RoleOfName> rigs = []
    {
        std::vector<RoleOfName> all;
        for (std::size_t rig = 0; rig < rigCount; ++rig)
            all.push_back(rolesOf(rig));
        return all;
    }();
    std::vector<std::string> caseless;
    for (const std::string& name : names)
        caseless.push_back(caselessJointName(name));
    std::vector<int> best;
    std::size_t bestCount = RigNames::minNames - 1;
    for (const RoleOfName& rig : rigs)
    {
        std::vector<int> own;
        for (const std::string& name : caseless)
        {
            const auto found = rig.find(name);
            own.push_back(found == rig.end() ? -1 : found->second);
        }
        const auto count =
            static_cast<std::size_t>(std::count_if(own.begin(), own.end(), [](int role) { return role >= 0; }));
        if (count <= bestCount) continue;
        bestCount = count;
        best = std::move(own);
    }
    return best;
}

} // namespace

std::vector<int> RigNames::counterparts(const std::vector<std::string>& names, const std::vector<std::string>& others)
{
    std::vector<int> found(names.size(), -1);
    const std::vector<int> own = rolesOf(names), other = rolesOf(others);
    if (own.empty() || other.empty()) return found;
    std::unordered_map<int, int> ofRole;
    for (std::size_t i = 0; i < other.size(); ++i)
        if (other[i] >= 0) ofRole.emplace(other[i], static_cast<int>(i));
    for (std::size_t i = 0; i < own.size(); ++i)
        if (const auto role = ofRole.find(own[i]); own[i] >= 0 && role != ofRole.end()) found[i] = role->second;
    return found;
}

void RigNames::addCounterparts(const std::vector<std::string>& names, const std::vector<std::string>& others,
                               const std::map<std::string, std::string>& given, std::vector<int>& counterparts)
{
    const std::vector<int> ofRole = RigNames::counterparts(names, others);
    std::vector<bool> isTaken(others.size(), false);
    for (const int counterpart : counterparts)
        if (counterpart >= 0) isTaken[static_cast<std::size_t>(counterpart)] = true;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (counterparts[i] < 0 && ofRole[i] >= 0 && given.count(names[i]) == 0 &&
            !isTaken[static_cast<std::size_t>(ofRole[i])])
            counterparts[i] = ofRole[i];
}

} // namespace osgGpuAnimation
