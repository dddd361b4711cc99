// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "Scenes.h"

#include <set>
#include <string>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// The crowd with outfits, by turns of its instances.
osg::ref_ptr<AnimatedCrowd> withOutfits(const osg::ref_ptr<AnimatedCrowd>& alike,
                                        const std::vector<std::set<std::string>>& hidden)
{
    osg::ref_ptr<AnimatedCrowd> crowd = osg::clone(alike.get(), osg::CopyOp::SHALLOW_COPY);
    std::vector<osg::ref_ptr<Outfit>> outfits;
    for (const std::set<std::string>& parts : hidden)
    {
        outfits.push_back(new Outfit);
        for (const std::string& part : parts)
            outfits.back()->setVisible(part, false);
        taken(crowd->getOutfits().add(outfits.back()));
    }
    // Instances of a new crowd have the handles 0, 1, 2 …
    for (AnimatedCrowd::Instance i = 0; i < crowd->getNumInstances(); ++i)
        taken(crowd->setOutfit(i, outfits[i % outfitCount]));
    return crowd;
}

/// The same as a crowd for each outfit.
osg::ref_ptr<osg::Group> asCrowds(const AnimatedCrowd& alike, const std::vector<std::set<std::string>>& hidden)
{
    osg::ref_ptr<osg::Group> crowds = new osg::Group;
    for (std::size_t outfit = 0; outfit < outfitCount; ++outfit)
    {
        osg::ref_ptr<AnimatedCrowd> crowd = osg::clone(&alike, osg::CopyOp::SHALLOW_COPY);
        for (AnimatedCrowd::Instance i = 0; i < alike.getNumInstances(); ++i)
            if (i % outfitCount != outfit) crowd->remove(i);
        for (const std::string& part : hidden[outfit])
            taken(crowd->getMeshes().setVisible(part, false));
        crowds->addChild(crowd);
    }
    return crowds;
}

} // namespace

void measureOutfits(const Subject& subject, Run& run)
{
    const std::vector<std::set<std::string>> hidden = hiddenParts(subject);
    if (hidden.empty()) return;
    const auto ratio = [&](std::size_t count, const char* what, const Series& ours, const char* than,
                           const Series& theirs, double limit)
    {
        run.report.add(Row(subject.name, count, what, "µs an instance", ours, 1e6 / static_cast<double>(count))
                           .against(than, theirs)
                           .atMost(limit));
    };
    for (const auto& [count, pixelError] : {std::pair<std::size_t, float>(960, 0.0f), {10000, 0.5f}})
    {
        const osg::ref_ptr<AnimatedCrowd> alike = makeCrowd(subject, count);
        taken(alike->getMeshes().setPixelError(pixelError));
        alike->getMeshes().waitForLevels();
        const osg::ref_ptr<AnimatedCrowd> dressed = withOutfits(alike, hidden);
        dressed->getMeshes().waitForLevels();
        std::vector<osg::ref_ptr<osg::Node>> scenes{alike, dressed};
        if (pixelError == 0.0f) scenes.emplace_back(asCrowds(*alike, hidden));
        const Viewers viewers = viewersFromAbove(scenes, alike->getBound());
        const std::vector<Costs> costs = race(viewers, run.rounds);
        ratio(count, "24 outfits, update + cull", costs[1].updateAndCull, "all alike", costs[0].updateAndCull, 1.2);
        if (pixelError > 0.0f)
            ratio(count, "24 outfits, pixel error, whole frame", costs[1].whole, "all alike", costs[0].whole, 1.25);
        else
            ratio(count, "24 outfits, whole frame", costs[1].whole, "24 crowds", costs[2].whole, 1.05);
    }
}

} // namespace osgGpuAnimation::benchmark
