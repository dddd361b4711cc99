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

/// Indices by name.
class NameIndex
{
public:
    void add(const std::string& name, int index)
    {
        if (!name.empty()) _indices[name].push_back(index);
    }

    /// The n-th of that name, the first one where there are fewer; -1: none.
    int find(const std::string& name, std::size_t n) const
    {
        const auto found = _indices.find(name);
        if (found == _indices.end()) return -1;
        return found->second[n < found->second.size() ? n : 0];
    }

private:
    std::unordered_map<std::string, std::vector<int>> _indices;
};

constexpr std::size_t rigCount = 7;

/// The sides that replace `?`, left and right.
constexpr const char* sides[rigCount][2] = {{"left", "right"}, {"left", "right"}, {"l", "r"}, {"left", "right"},
                                            {"l", "r"},        {"l", "r"},        {"l", "r"}};

/// The bones of a finger, which replace `*`; their numbers, from 1 on, replace `#`.
constexpr const char* bones[] = {"proximal", "intermediate", "distal"};

/// A role in each rig, as caselessJointName() has the names; empty: the rig has no such joint.
constexpr const char* roles[][rigCount] = {
    // Mixamo, CMU's BVH, Unreal, VRM, VRoid, Rigify, and names like UpperArm_L
    {"hips", "hips", "pelvis", "hips", "j_bip_c_hips", "def-spine", "hips"},
    {"spine", "lowerback", "spine_01", "spine", "j_bip_c_spine", "def-spine_001", "spine"},
    {"spine1", "spine", "spine_02", "chest", "j_bip_c_chest", "def-spine_002", ""},
    {"spine2", "spine1", "spine_03", "upperchest", "j_bip_c_upperchest", "def-spine_003", "chest"},
    {"neck", "neck", "neck_01", "neck", "j_bip_c_neck", "def-spine_004", "neck"},
    {"head", "head", "head", "head", "j_bip_c_head", "def-spine_006", "head"},
    {"?shoulder", "?shoulder", "clavicle_?", "?shoulder", "j_bip_?_shoulder", "def-shoulder_?", "shoulder_?"},
    {"?arm", "?arm", "upperarm_?", "?upperarm", "j_bip_?_upperarm", "def-upper_arm_?", "upperarm_?"},
    {"?forearm", "?forearm", "lowerarm_?", "?lowerarm", "j_bip_?_lowerarm", "def-forearm_?", "lowerarm_?"},
    {"?hand", "?hand", "hand_?", "?hand", "j_bip_?_hand", "def-hand_?", "hand_?"},
    {"?upleg", "?upleg", "thigh_?", "?upperleg", "j_bip_?_upperleg", "def-thigh_?", "upperleg_?"},
    {"?leg", "?leg", "calf_?", "?lowerleg", "j_bip_?_lowerleg", "def-shin_?", "lowerleg_?"},
    {"?foot", "?foot", "foot_?", "?foot", "j_bip_?_foot", "def-foot_?", "foot_?"},
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
                                  const std::map<std::string, std::string>& given)
{
    NameIndex exact, bare, caseless;
    for (std::size_t other = 0; other < others.size(); ++other)
    {
        exact.add(others[other], static_cast<int>(other));
        bare.add(bareJointName(others[other]), static_cast<int>(other));
        caseless.add(caselessJointName(others[other]), static_cast<int>(other));
    }
    const auto wantedBy = [&](const std::string& name) -> const std::string&
    {
        const auto entry = given.find(name);
        return entry == given.end() ? name : entry->second;
    };
    std::unordered_map<std::string, std::size_t> exactCounts, bareCounts, caselessCounts;
    std::vector<bool> isTaken(others.size(), false);
    std::vector<int> counterparts;
    for (const std::string& name : names)
    {
        const std::string& wanted = wantedBy(name);
        const std::string wantedBare = bareJointName(wanted);
        const int same = exact.find(wanted, exactCounts[wanted]++);
        const int similar = bare.find(wantedBare, bareCounts[wantedBare]++);
        counterparts.push_back(same >= 0 ? same : similar);
        if (counterparts.back() >= 0) isTaken[static_cast<std::size_t>(counterparts.back())] = true;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        if (counterparts[i] >= 0) continue;
        const std::string wanted = caselessJointName(wantedBy(names[i]));
        const int found = caseless.find(wanted, caselessCounts[wanted]++);
        if (found >= 0 && !isTaken[static_cast<std::size_t>(found)]) counterparts[i] = found;
    }
    return counterparts;
}

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
