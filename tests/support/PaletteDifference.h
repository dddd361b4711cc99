// SPDX-License-Identifier: MIT
#pragma once

#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/math/Box.h>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace osgGpuAnimation
{

/// The largest difference of two palettes, relative to the larger of 1 and the largest expected number. 1e30 if their
/// sizes differ or a number is not finite. Entry: AffineMatrix or glm::dmat4.
template <typename Entry>
double paletteDifference(const std::vector<AffineMatrix>& palette, const std::vector<Entry>& expected)
{
    if (palette.size() != expected.size()) return 1e30;
    double worst = 0.0, size = 1.0;
    for (std::size_t entry = 0; entry < palette.size(); ++entry)
    {
        glm::dmat4 wanted;
        if constexpr (std::is_same_v<Entry, AffineMatrix>)
            wanted = expected[entry].toColumns();
        else
            wanted = expected[entry];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const double found = static_cast<double>(palette[entry].rows[static_cast<std::size_t>(row)][column]);
                worst = std::max(worst, std::isfinite(found) ? std::abs(found - wanted[column][row]) : 1e30);
                size = std::max(size, std::abs(wanted[column][row]));
            }
    }
    return worst / size;
}

/// The tracks of the controller's present pose.
inline std::vector<JointTransform> mixed(const AnimationController& controller)
{
    std::vector<JointTransform> tracks;
    Pose::mix(controller.set(), controller.instruction(), tracks);
    return tracks;
}

/// The largest difference of translation, rotation (either sign of the quaternion) and scale.
inline double distance(const JointTransform& a, const JointTransform& b)
{
    return std::max(
        {static_cast<double>(glm::distance(a.translation, b.translation)),
         static_cast<double>(std::min(glm::distance(a.rotation, b.rotation), glm::distance(a.rotation, -b.rotation))),
         static_cast<double>(glm::distance(a.scale, b.scale))});
}

/// The largest distance of two columns.
inline double distance(const glm::dmat4& a, const glm::dmat4& b)
{
    double worst = 0.0;
    for (int column = 0; column < 4; ++column)
        worst = std::max(worst, glm::length(a[column] - b[column]));
    return worst;
}

/// The largest distance between the corners of the boxes in two palettes of a set, in the model's units.
inline double largestDistance(const AnimationSet& set, const std::vector<AffineMatrix>& a,
                              const std::vector<AffineMatrix>& b, const EntryBoxes& boxes)
{
    double worst = 0.0;
    for (std::size_t entry = 0; entry < boxes.size(); ++entry)
        for (int i = 0; i < 8 && !boxes[entry].empty() && set.palette()[entry].kind != PaletteEntry::Kind::Weights; ++i)
        {
            const glm::vec3 corner = boxes[entry].corner(i);
            const float apart = glm::distance(a[entry].transformPoint(corner), b[entry].transformPoint(corner));
            worst = std::max(worst, static_cast<double>(apart));
        }
    return worst;
}

/// The same of two sets of one skeleton at that time of the clip, from palettes of the CPU twin.
inline double distanceAt(const AnimationSet& a, const AnimationSet& b, int clip, double time, const EntryBoxes& boxes)
{
    std::vector<AffineMatrix> ofA, ofB;
    Pose::evaluate(a, instructionAt(a, clip, time), AffineMatrix(), ofA);
    Pose::evaluate(b, instructionAt(b, clip, time), AffineMatrix(), ofB);
    return largestDistance(a, ofA, ofB, boxes);
}

/// The largest distanceAt() at all keyframes of a's clip, halfway between them and at that many random times.
inline double largestDistance(const AnimationSet& a, const AnimationSet& b, int clip, const EntryBoxes& boxes,
                              int randomTimes)
{
    const Clip& exact = a.clips()[static_cast<std::size_t>(clip)];
    std::vector<double> times(exact.times().begin(), exact.times().end());
    for (std::size_t k = 0; k + 1 < exact.keyframeCount(); ++k)
        times.push_back(0.5 * (times[k] + times[k + 1]));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(0.0, exact.duration());
    for (int i = 0; i < randomTimes; ++i)
        times.push_back(anywhere(random));
    double worst = 0.0;
    for (const double time : times)
        worst = std::max(worst, distanceAt(a, b, clip, time, boxes));
    return worst;
}

/// A cube with that half side around the origin for each palette entry.
inline EntryBoxes cubes(const AnimationSet& set, float halfSide)
{
    Box cube;
    cube.add(glm::vec3(-halfSide));
    cube.add(glm::vec3(halfSide));
    return EntryBoxes(set.paletteSize(), cube);
}

} // namespace osgGpuAnimation
