// SPDX-License-Identifier: MIT
#pragma once

#include "plugin/PluginFolder.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// OSG's own formats, without the dot.
constexpr const char* storedFormats[] = {"osgb", "osgt", "osgx"};

/// For tests that store scenes in OSG's own formats: osgDB finds the plugins of the build, and the files are in a
/// temporary folder.
class StoredScene
{
public:
    StoredScene() { usePluginsOfTheBuild(); }

    /// Writes the node to a file of that format and reads it back; null if that fails.
    osg::ref_ptr<osg::Node> throughFile(const osg::Node& node, const std::string& format) const
    {
        const std::string file = folder.file("scene." + format);
        return osgDB::writeNodeFile(node, file) ? osgDB::readRefNodeFile(file) : nullptr;
    }

    ScratchFolder folder;
};

/// The largest difference of two palettes' numbers; huge if their sizes differ.
inline float paletteDifference(const AnimationController& a, const AnimationController& b)
{
    std::vector<AffineMatrix> first, second;
    Pose::evaluate(a.set(), a.instruction(), AffineMatrix(), first);
    Pose::evaluate(b.set(), b.instruction(), AffineMatrix(), second);
    if (first.size() != second.size()) return 1e30f;
    float worst = 0.0f;
    for (std::size_t entry = 0; entry < first.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const float difference = std::abs(first[entry].rows[row][column] - second[entry].rows[row][column]);
                worst = std::max(worst, std::isfinite(difference) ? difference : 1e30f);
            }
    return worst;
}

/// True if the keyframes of two sets are equal bit by bit.
inline bool haveSameKeyframes(const AnimationSet& a, const AnimationSet& b)
{
    if (a.clips().size() != b.clips().size()) return false;
    for (std::size_t clip = 0; clip < a.clips().size(); ++clip)
    {
        const std::vector<JointTransform>& first = a.clips()[clip].data();
        const std::vector<JointTransform>& second = b.clips()[clip].data();
        const bool isSame = first.size() == second.size() &&
                            std::memcmp(first.data(), second.data(), first.size() * sizeof(JointTransform)) == 0;
        if (!isSame || a.clips()[clip].times() != b.clips()[clip].times()) return false;
    }
    return true;
}

} // namespace osgGpuAnimation
