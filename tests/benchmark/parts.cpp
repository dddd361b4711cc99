// SPDX-License-Identifier: MIT
// The parts that run on the CPU, one by one.
#include "ChainSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <benchmark/benchmark.h>

#include <osg/MatrixTransform>

#include <cmath>

namespace
{

using osgGpuAnimation::AffineMatrix;
using osgGpuAnimation::AnimationController;
using osgGpuAnimation::AnimationSet;
using osgGpuAnimation::PoseBatch;
using osgGpuAnimation::benchmark::makeChains;
namespace Pose = osgGpuAnimation::Pose;

AnimationController playing(const std::shared_ptr<const AnimationSet>& set)
{
    AnimationController controller(set);
    static_cast<void>(controller.play(0));
    return controller;
}

void advance(benchmark::State& state)
{
    AnimationController controller = playing(makeChains(8, 8));
    for (auto _ : state)
        benchmark::DoNotOptimize(controller.advance(1.0 / 60.0));
}
BENCHMARK(advance);

void advanceOfTwoLayers(benchmark::State& state)
{
    AnimationController controller = playing(makeChains(8, 8));
    static_cast<void>(controller.layer(1).play(0));
    controller.layer(1).setWeight(0.5);
    for (auto _ : state)
        benchmark::DoNotOptimize(controller.advance(1.0 / 60.0));
}
BENCHMARK(advanceOfTwoLayers);

void fillBatch(benchmark::State& state)
{
    const auto set = makeChains(8, 8);
    const AnimationController controller = playing(set);
    PoseBatch batch(set);
    for (auto _ : state)
    {
        batch.clear();
        for (int instance = 0; instance < 1000; ++instance)
            batch.add(controller.instruction());
    }
    state.SetItemsProcessed(state.iterations() * 1000);
}
BENCHMARK(fillBatch);

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

void poseOnTheCpu(benchmark::State& state)
{
    const auto set = makeChains(8, 8);
    AnimationController controller = playing(set);
    std::vector<AffineMatrix> palette;
    for (auto _ : state)
    {
        Pose::evaluate(*set, controller.advance(1.0 / 60.0), AffineMatrix(), palette);
        benchmark::DoNotOptimize(palette.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(set->paletteSize()));
}
BENCHMARK(poseOnTheCpu);

} // namespace

BENCHMARK_MAIN();
