// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/retarget/JointNames.h>

#include <algorithm>
#include <cctype>
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
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
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

} // namespace osgGpuAnimation
