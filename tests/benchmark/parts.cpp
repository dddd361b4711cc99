// SPDX-License-Identifier: MIT
// The parts that run on the CPU, one by one.
#include "ChainSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <benchmark/benchmark.h>

#include <osg/MatrixTransform>

#include <cmath>

namespace
{

using osgGpuAnimation::AnimationController;
using osgGpuAnimation::AnimationSet;
using osgGpuAnimation::benchmark::makeChains;

void advanceOfTwoLayers(benchmark::State& state)
{
    AnimationController controller(makeChains(8, 8));
    static_cast<void>(controller.play(0));
    static_cast<void>(controller.layer(1).play(0));
    controller.layer(1).setWeight(0.5);
    for (auto _ : state)
        benchmark::DoNotOptimize(controller.advance(1.0 / 60.0));
}
BENCHMARK(advanceOfTwoLayers);

/// The update of a crowd whose clips rest. The range: how many of 10,000 look at a node that moves.
void follow(benchmark::State& state)
{
    using namespace osgGpuAnimation;
    const auto set = makeChains(8, 8)->withConstraints({LookAt{"look", {"joint 9", "joint 17"}}}).value();
    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform;
    for (int i = 0; i < 10000; ++i)
    {
        const auto instance = crowd->add(osg::Matrix::translate(i % 100, i / 100, 0), AnimationController(set)).value();
        if (i < state.range(0)) static_cast<void>(crowd->constraint(instance, "look").follow(bird));
    }
    double angle = 0.0;
    for (auto _ : state)
    {
        bird->setMatrix(osg::Matrix::translate(50.0 + 40.0 * std::cos(angle += 0.01), 50.0, 5.0));
        crowd->update(0.0);
    }
    state.SetItemsProcessed(state.iterations() * 10000);
}
BENCHMARK(follow)->Arg(0)->Arg(10000);

} // namespace

BENCHMARK_MAIN();
