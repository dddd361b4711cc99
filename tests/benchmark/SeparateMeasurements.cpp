// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <string>
#include <utility>

namespace osgGpuAnimation::benchmark
{

void measureSeparate(const Subject& subject, Run& run)
{
    constexpr std::size_t count = 960;
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(subject, count);
    CharacterScene alike(subject, count), dressed(subject, count);
    const std::vector<std::set<std::string>> hidden = hiddenParts(subject);
    std::vector<osg::ref_ptr<osg::Node>> scenes{crowd, alike.root};
    if (!hidden.empty())
    {
        for (std::size_t i = 0; i < count; ++i)
            for (const std::string& part : hidden[i % hidden.size()])
                taken(dressed.characters[i]->getMeshes().setVisible(part, false));
        scenes.push_back(dressed.root);
    }
    const Viewers viewers = viewersFromAbove(scenes, crowd->getBound());
    const std::vector<Costs> costs = race(viewers, run.rounds);
    const char* const names[] = {"one crowd", "separate, alike", "separate, 24 sets of hidden parts"};
    for (std::size_t scene = 1; scene < scenes.size(); ++scene)
        for (const auto& [stage, series] :
             {std::pair("update", &Costs::update), {"cull", &Costs::cull}, {"draw", &Costs::draw}})
            run.report.add(
                Row(subject.name, count, std::string(names[scene]) + ", " + stage, "ms", costs[scene].*series, 1e3)
                    .against(names[0], costs[0].*series));
}

} // namespace osgGpuAnimation::benchmark
