// SPDX-License-Identifier: MIT
#include "SerpentRig.h"

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

const double step = serpentLength / serpentSegments;

glm::dvec3 spineAt(double distance)
{
    return {0.0, serpentHeight, serpentNeck - distance};
}

} // namespace

Rig makeSerpentRig()
{
    Rig rig;
    std::string parent;
    for (int segment = 0; segment < serpentSegments; ++segment)
    {
        const std::string name = "Spine" + std::to_string(segment);
        rig.add(name, parent, spineAt(step * segment), spineAt(step * (segment + 1)));
        parent = name;
    }
    rig.add("Head", "Spine0", spineAt(0.0), spineAt(-0.2));
    rig.add("Jaw", "Head", spineAt(-0.09) - glm::dvec3(0.0, 0.035, 0.0), spineAt(-0.30) - glm::dvec3(0.0, 0.05, 0.0));
    rig.addPair("Fin", "Spine3", spineAt(0.24) + glm::dvec3(0.09, -0.03, 0.0),
                spineAt(0.36) + glm::dvec3(0.30, -0.10, 0.0));
    return rig;
}

Binding serpentBindingAt(const Rig& rig, double distance)
{
    const double half = 0.5 * step;
    if (distance < -half) return Binding(rig.index("Head"));
    if (distance < half) return Binding(rig.index("Head")).give((distance + half) / step, rig.index("Spine0"));
    // A joint turns at the segment's front end: the passage from one segment to the next lies around it.
    const double place = (distance - half) / step;
    const int segment = std::min(static_cast<int>(place), serpentSegments - 1);
    const int next = std::min(segment + 1, serpentSegments - 1);
    return Binding(rig.index("Spine" + std::to_string(segment)))
        .give(place - std::floor(place), rig.index("Spine" + std::to_string(next)));
}

} // namespace osgGpuAnimation::scenes
