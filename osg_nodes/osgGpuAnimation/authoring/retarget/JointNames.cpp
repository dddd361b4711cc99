// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/retarget/JointNames.h>

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

std::vector<int> findCounterparts(const std::vector<std::string>& names, const std::vector<std::string>& others,
                                  const std::map<std::string, std::string>& given)
{
    NameIndex exact, bare;
    for (std::size_t other = 0; other < others.size(); ++other)
    {
        exact.add(others[other], static_cast<int>(other));
        bare.add(bareJointName(others[other]), static_cast<int>(other));
    }
    std::unordered_map<std::string, std::size_t> exactCounts, bareCounts;
    std::vector<int> counterparts;
    for (const std::string& name : names)
    {
        const auto entry = given.find(name);
        const std::string& wanted = entry == given.end() ? name : entry->second;
        const std::string wantedBare = bareJointName(wanted);
        const int same = exact.find(wanted, exactCounts[wanted]++);
        const int similar = bare.find(wantedBare, bareCounts[wantedBare]++);
        counterparts.push_back(same >= 0 ? same : similar);
    }
    return counterparts;
}

} // namespace osgGpuAnimation
