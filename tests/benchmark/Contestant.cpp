// SPDX-License-Identifier: MIT
#include "Contestant.h"

#include <malloc.h>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr double frameTime = 1.0 / 60.0;

} // namespace

FrameCost Contestant::frame()
{
    return viewer->frame(time += frameTime);
}

void Contestant::measure()
{
    const FrameCost cost = frame();
    whole.push_back(cost.whole());
    updateAndCull.push_back(cost.updateAndCull());
    draw.push_back(cost.draw);
}

Result<Contestant> contestant(osg::Node* scene, const osg::BoundingSphere& sight, int width, int height)
{
    Result<std::shared_ptr<StagedViewer>> viewer = StagedViewer::create(scene, sight, width, height);
    if (!viewer) return viewer.error();
    Contestant made;
    made.viewer = std::move(viewer.value());
    return made;
}

void race(std::vector<Contestant>& contestants, int rounds)
{
    for (Contestant& each : contestants)
        for (int frame = 0; frame < 3; ++frame)
            each.frame();
    for (int round = 0; round < rounds; ++round)
        for (Contestant& each : contestants)
            each.measure();
}

std::string check(std::vector<Contestant>& contestants)
{
    for (std::size_t i = 0; i < contestants.size(); ++i)
    {
        const std::string errors = contestants[i].viewer->takeErrors();
        if (!errors.empty()) return "GL reports " + errors + "in scene " + std::to_string(i);
        if (contestants[i].viewer->pixelsDrawn() < 4) return "scene " + std::to_string(i) + " is empty";
    }
    return "";
}

double bytesInUse()
{
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

Row named(Row row, const Subject& subject, std::size_t count, const std::string& what, const char* unit,
          const char* other)
{
    row.subject = subject.name;
    row.count = count;
    row.what = what;
    row.unit = unit;
    row.otherName = other;
    return row;
}

Row limited(const Figure& ours, double limit, const std::string& bar, const Subject& subject, std::size_t count,
            const std::string& what, const char* unit)
{
    Row row = named({}, subject, count, what, unit, "");
    row.ours = ours;
    row.bar = bar;
    row.isMet = ours.median <= limit;
    return row;
}

} // namespace osgGpuAnimation::benchmark
