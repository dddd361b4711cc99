// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/retarget/JointNames.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <unordered_map>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t rigCount = 7;

/// The sides that replace `?`, left and right.
constexpr const char* sides[rigCount][2] = {{"left", "right"}, {"left", "right"}, {"l", "r"}, {"left", "right"},
                                            {"l", "r"},        {"l", "r"},        {"l", "r"}};

/// The bones of a finger, which replace `*`; their numbers, from 1 on, replace `#`.
constexpr const char* bones[] = {"proximal", "intermediate", "distal"};

/// A role in each rig, as caselessJointName() has the names; empty: the rig has no such joint.
constexpr const char* roles[][rigCount] = {
    // Mixamo, CMU's BVH, Unreal, VRM, VRoid, Rigify, and names like UpperArm_L; bones of limbs first, see limbBones()
    {"?arm", "?arm", "upperarm_?", "?upperarm", "j_bip_?_upperarm", "def-upper_arm_?", "upperarm_?"},
    {"?forearm", "?forearm", "lowerarm_?", "?lowerarm", "j_bip_?_lowerarm", "def-forearm_?", "lowerarm_?"},
    {"?hand", "?hand", "hand_?", "?hand", "j_bip_?_hand", "def-hand_?", "hand_?"},
    {"?upleg", "?upleg", "thigh_?", "?upperleg", "j_bip_?_upperleg", "def-thigh_?", "upperleg_?"},
    {"?leg", "?leg", "calf_?", "?lowerleg", "j_bip_?_lowerleg", "def-shin_?", "lowerleg_?"},
    {"?foot", "?foot", "foot_?", "?foot", "j_bip_?_foot", "def-foot_?", "foot_?"},
    {"hips", "hips", "pelvis", "hips", "j_bip_c_hips", "def-spine", "hips"},
    {"spine", "lowerback", "spine_01", "spine", "j_bip_c_spine", "def-spine_001", "spine"},
    {"spine1", "spine", "spine_02", "chest", "j_bip_c_chest", "def-spine_002", ""},
    {"spine2", "spine1", "spine_03", "upperchest", "j_bip_c_upperchest", "def-spine_003", "chest"},
    {"neck", "neck", "neck_01", "neck", "j_bip_c_neck", "def-spine_004", "neck"},
    {"head", "head", "head", "head", "j_bip_c_head", "def-spine_006", "head"},
    {"?shoulder", "?shoulder", "clavicle_?", "?shoulder", "j_bip_?_shoulder", "def-shoulder_?", "shoulder_?"},
    {"?toebase", "?toebase", "ball_?", "?toes", "j_bip_?_toebase", "def-toe_?", "toes_?"},
    {"?handthumb#", "", "thumb_0#_?", "?thumb*", "j_bip_?_thumb#", "def-thumb_0#_?", ""},
    {"?handindex#", "", "index_0#_?", "?index*", "j_bip_?_index#", "def-f_index_0#_?", ""},
    {"?handmiddle#", "", "middle_0#_?", "?middle*", "j_bip_?_middle#", "def-f_middle_0#_?", ""},
    {"?handring#", "", "ring_0#_?", "?ring*", "j_bip_?_ring#", "def-f_ring_0#_?", ""},
    {"?handpinky#", "", "pinky_0#_?", "?little*", "j_bip_?_little#", "def-f_pinky_0#_?", ""},
};

/// By name: a number of the row, the side and the bone. Names of one bone, or of no side, have those of the last.
using RoleOfName = std::unordered_map<std::string, int>;

RoleOfName rolesOf(std::size_t rig)
{
    RoleOfName result;
    for (std::size_t row = 0; row < std::size(roles); ++row)
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t bone = 0; bone < std::size(bones); ++bone)
            {
                std::string name = roles[row][rig];
                const auto put = [&](char mark, const std::string& text)
                {
                    if (const std::size_t at = name.find(mark); at != std::string::npos) name.replace(at, 1, text);
                };
                put('?', sides[rig][side]);
                put('#', std::to_string(bone + 1));
                put('*', bones[bone]);
                if (!name.empty()) result[name] = static_cast<int>((row * 2 + side) * std::size(bones) + bone);
            }
    return result;
}

/// A skeleton with fewer names of a rig has another one: half a body must not move without the other half.
constexpr std::size_t minNames = 12;

/// One role per name of a skeleton; -1: none, and all if the skeleton is of no known rig. The rig is the one of which
/// it has the most names.
std::vector<int> rolesOf(const std::vector<std::string>& names)
{
    static const std::vector<RoleOfName> rigs = []
    {
        std::vector<RoleOfName> all;
        for (std::size_t rig = 0; rig < rigCount; ++rig)
            all.push_back(rolesOf(rig));
        return all;
    }();
    std::vector<std::vector<int>> byRig(rigCount);
    for (const std::string& name : names)
    {
        const std::string caseless = caselessJointName(name);
        for (std::size_t rig = 0; rig < rigCount; ++rig)
        {
            const auto found = rigs[rig].find(caseless);
            byRig[rig].push_back(found == rigs[rig].end() ? -1 : found->second);
        }
    }
    const auto namesOf = [](const std::vector<int>& rig)
    { return rig.size() - static_cast<std::size_t>(std::count(rig.begin(), rig.end(), -1)); };
    const auto best = std::max_element(byRig.begin(), byRig.end(),
                                       [&](const auto& a, const auto& b) { return namesOf(a) < namesOf(b); });
    return namesOf(*best) >= minNames ? *best : std::vector<int>(names.size(), -1);
}

/// What names are matched by, one per name; an empty text matches nothing.
using Keys = std::vector<std::string>;

Keys roleKeys(const std::vector<std::string>& names)
{
    Keys keys;
    for (const int role : rolesOf(names))
        keys.push_back(role < 0 ? "" : std::to_string(role));
    return keys;
}

} // namespace

std::string bareJointName(const std::string& name)
{
    const std::size_t separator = name.find_last_of(":|");
    std::string bare = separator == std::string::npos ? name : name.substr(separator + 1);
    static const std::string prefix = "mixamorig";
    if (bare.compare(0, prefix.size(), prefix) == 0)
    {
        std::size_t end = bare.find_first_not_of("0123456789", prefix.size());
        if (end != std::string::npos && bare[end] == '_') ++end;
        if (end < bare.size()) bare.erase(0, end);
    }
    return bare.empty() ? name : bare;
}

std::string caselessJointName(const std::string& name)
{
    std::string folded = bareJointName(name);
    std::transform(folded.begin(), folded.end(), folded.begin(),
                   [](unsigned char letter) { return letter == '.' ? '_' : static_cast<char>(std::tolower(letter)); });
    return folded;
}

std::vector<int> findCounterparts(const std::vector<std::string>& names, const std::vector<std::string>& others,
                                  const std::map<std::string, std::string>& given, bool byRole)
{
    if (names.empty()) return {};
    Keys wanted = names, ownRoles = byRole ? roleKeys(names) : Keys(names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
        if (const auto entry = given.find(names[i]); entry != given.end())
        {
            wanted[i] = entry->second;
            ownRoles[i].clear();
        }
    std::vector<int> counterparts(names.size(), -1);
    std::vector<bool> isTaken(others.size(), false);
    const auto match = [&](const Keys& keys, const Keys& otherKeys, bool share)
    {
        std::unordered_map<std::string, std::vector<std::size_t>> ofKey;
        for (std::size_t other = 0; other < otherKeys.size(); ++other)
            if (share || !isTaken[other]) ofKey[otherKeys[other]].push_back(other);
        std::unordered_map<std::string, std::size_t> counts;
        for (std::size_t i = 0; i < keys.size(); ++i)
        {
            const auto found = ofKey.find(keys[i]);
            if (keys[i].empty() || found == ofKey.end() || (!share && counterparts[i] >= 0)) continue;
            const std::size_t n = counts[keys[i]]++;
            if (counterparts[i] >= 0) continue;
            const std::size_t other = found->second[n < found->second.size() ? n : 0];
            counterparts[i] = static_cast<int>(other);
            isTaken[other] = true;
        }
    };
    const auto each = [](Keys keys, const auto& key)
    {
        std::transform(keys.begin(), keys.end(), keys.begin(), key);
        return keys;
    };
    match(wanted, others, true);
    match(each(wanted, bareJointName), each(others, bareJointName), true);
    match(each(wanted, caselessJointName), each(others, caselessJointName), false);
    if (byRole) match(ownRoles, roleKeys(others), false);
    return counterparts;
}

std::vector<int> limbBones(const std::vector<std::string>& names)
{
    constexpr int perSide = static_cast<int>(std::size(bones)), end = 12 * perSide; // six rows, two sides
    std::vector<int> found = rolesOf(names);
    for (int& role : found)
        role = role >= 0 && role < end ? role / perSide : -1;
    return found;
}

} // namespace osgGpuAnimation
