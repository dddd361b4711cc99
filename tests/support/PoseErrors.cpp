// SPDX-License-Identifier: MIT
#include "support/PoseErrors.h"

#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <random>

namespace osgGpuAnimation
{

double distanceAt(const AnimationSet& a, const AnimationSet& b, int clip, double time, const EntryBoxes& boxes)
{
    std::vector<AffineMatrix> ofA, ofB;
    Pose::evaluate(a, instructionAt(a, clip, time), AffineMatrix(), ofA);
    Pose::evaluate(b, instructionAt(b, clip, time), AffineMatrix(), ofB);
    double worst = 0.0;
    for (std::size_t entry = 0; entry < boxes.size(); ++entry)
    {
        if (boxes[entry].empty() || a.palette()[entry].kind == PaletteEntry::Kind::Weights) continue;
        for (int i = 0; i < 8; ++i)
        {
            const glm::vec3 corner = boxes[entry].corner(i);
            const float apart = glm::distance(ofA[entry].transformPoint(corner), ofB[entry].transformPoint(corner));
            worst = std::max(worst, static_cast<double>(apart));
        }
    }
    return worst;
}

double largestDistance(const AnimationSet& a, const AnimationSet& b, int clip, const EntryBoxes& boxes, int randomTimes)
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

EntryBoxes cubes(const AnimationSet& set, float halfSide)
{
    Box cube;
    cube.add(glm::vec3(-halfSide));
    cube.add(glm::vec3(halfSide));
    return EntryBoxes(set.paletteSize(), cube);
}

} // namespace osgGpuAnimation
