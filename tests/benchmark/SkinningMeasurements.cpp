// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Measurements.h"
#include "Scenes.h"

#include <iostream>

namespace osgGpuAnimation::benchmark
{

Result<void> measureDraws(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": draws" << std::endl;
    const std::size_t count = effort.frameCount;
    CharacterScene ours(subject, count);
    CharacterScene apart(subject, count);
    for (CharacterScene* scene : {&ours, &apart})
        scene->pause(); // palettes stay valid, so that only the draws are measured
    for (const osg::ref_ptr<AnimatedCharacter>& character : apart.characters)
        character->setDrawnTogether(false);
    const osg::ref_ptr<osg::Group> plain = makeUnskinnedScene(subject, count, Shading::AsCharacters);
    const osg::ref_ptr<osg::Group> least = makeUnskinnedScene(subject, count, Shading::Least);
    std::vector<Contestant> contestants;
    for (const osg::ref_ptr<osg::Group>& scene : {ours.root, plain, apart.root, least})
    {
        Result<Contestant> made = contestant(scene, ours.root->getBound());
        if (!made) return made.error();
        contestants.push_back(std::move(made.value()));
    }
    race(contestants, effort.rounds);
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    Row row = named(compared(contestants[0].draw, contestants[1].draw, 1e6 / static_cast<double>(count), false),
                    subject, count, "skinned draw", "µs a character", "the same without skinning");
    row.bar = "≤ 1.6";
    row.isMet = row.ratio.median <= 1.6;
    report.add(row);
    report.add(named(compared(contestants[2].draw, contestants[1].draw, 1e6 / static_cast<double>(count), false),
                     subject, count, "skinned draw, one by one", "µs a character", "the same without skinning"));
    report.add(named(compared(contestants[0].draw, contestants[3].draw, 1e6 / static_cast<double>(count), false),
                     subject, count, "skinned draw", "µs a character", "the same triangles in one colour"));
    return {};
}

} // namespace osgGpuAnimation::benchmark
