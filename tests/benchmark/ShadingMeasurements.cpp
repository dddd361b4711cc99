// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Measurements.h"

#include <osgGpuAnimation/nodes/Environment.h>

#include <fstream>
#include <iostream>
#include <iterator>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr int side = 512; // pixels: fragments, not vertices, decide the cost

Result<osg::ref_ptr<osg::Group>> read(const Subject& subject, bool fixedLighting)
{
    std::ifstream stream(subject.fileName, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    gltf::ImportOptions options;
    options.fixedLighting = fixedLighting;
    options.noKeys = true;
    Result<gltf::ImportedModel> model = gltf::importModel(bytes, subject.fileName, options);
    if (!model) return model.error();
    model.value().character->getController().pause();
    return model.value().root;
}

} // namespace

Result<bool> measureShading(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": shading" << std::endl;
    const osg::ref_ptr<Environment> studio = new Environment;
    studio->setToneMapping(true);
    studio->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    std::vector<Contestant> contestants;
    for (const bool isFixed : {true, false, false})
    {
        const Result<osg::ref_ptr<osg::Group>> root = read(subject, isFixed);
        if (!root) return root.error();
        osg::BoundingSphere sight = root.value()->getBound();
        sight.radius() *= 0.2f;
        osg::ref_ptr<osg::Group> scene = root.value();
        if (contestants.size() == 2)
        {
            studio->addChild(scene);
            scene = studio;
        }
        Result<Contestant> made = contestant(scene, sight, side);
        if (!made) return made.error();
        contestants.push_back(std::move(made.value()));
    }
    race(contestants, effort.rounds);
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    const struct
    {
        const char* name;
        double most;
    } looks[] = {{"shading, one light", 1.8}, {"shading, studio", 2.5}};
    for (std::size_t look = 0; look < 2; ++look)
    {
        Row row = named(compared(contestants[look + 1].draw, contestants[0].draw, 1e9 / (side * side), false), subject,
                        1, looks[look].name, "ns a pixel", "the fixed pipeline's look");
        row.bar = look == 0 ? "≤ 1.8" : "≤ 2.5";
        row.isMet = row.ratio.median <= looks[look].most;
        report.add(row);
    }
    return true;
}

} // namespace osgGpuAnimation::benchmark
