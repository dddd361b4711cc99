// SPDX-License-Identifier: MIT
#include "ChainSet.h"
#include "GpuPage.h"
#include "GpuPasses.h"
#include "Measurements.h"
#include "PoseCrowd.h"
#include "Scenes.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// Characters of several sets of 48 joints in 8 levels: whole batches, so that a step has no work of controllers.
class Groups
{
public:
    Groups(std::size_t sets, std::size_t characters, osg::State& state) : _state(state)
    {
        for (std::size_t set = 0; set < sets; ++set)
        {
            Group group{makeChains(6, 8), {}, {}};
            for (std::size_t frame = 0; frame < frames; ++frame)
            {
                group.batches.emplace_back(group.set);
                for (std::size_t i = 0; i < characters; ++i)
                {
                    AnimationController controller(group.set);
                    static_cast<void>(controller.play(0));
                    controller.seek(phaseOf(i + set + 7 * frame, controller.duration()));
                    const PoseInstruction& instruction = controller.advance(0.0);
                    group.batches.back().add(instruction);
                    if (i + 1 == characters) group.lastOf.push_back(instruction);
                }
            }
            _groups.push_back(std::move(group));
        }
    }

    /// Uploads other samples than the step before and evaluates all.
    void step(const PosePipeline::Options& options)
    {
        PosePipeline& pipeline = *PosePipeline::of(_state);
        pipeline.options() = options;
        ++_frame;
        for (const Group& group : _groups)
            if (!pipeline.evaluate(_state, group.batches[_frame % frames], 0))
                throw std::runtime_error("there is no pose");
    }

    /// Requires the CPU twin's palettes.
    void check() const
    {
        const PosePipeline& pipeline = *PosePipeline::of(_state);
        for (const Group* group : {&_groups.front(), &_groups.back()})
        {
            const std::size_t last = group->batches.front().size() - 1;
            requireEqual(*group->set, group->lastOf[_frame % frames],
                         pipeline.readPalette(_state, *group->set, 0, last));
        }
        requireNoGlErrors();
    }

    /// Computes the palettes of a step by the twin alone.
    void computeByTwin() const
    {
        std::vector<AffineMatrix> palette;
        for (const Group& group : _groups)
            for (std::size_t i = 0; i < group.batches.front().size(); ++i)
            {
                const PoseBatch& batch = group.batches[_frame % frames];
                Pose::BatchedPose pose;
                pose.samples = &batch.samples()[i];
                pose.sampleCount = 1;
                Pose::evaluate(*group.set, pose, AffineMatrix(), palette);
            }
    }

    std::size_t entryCount() const // of all palettes
    {
        return _groups.size() * _groups.front().batches.front().size() * _groups.front().set->paletteSize();
    }

private:
    static constexpr std::size_t frames = 2;
    struct Group
    {
        std::shared_ptr<const AnimationSet> set;
        std::vector<PoseBatch> batches;      ///< by frame
        std::vector<PoseInstruction> lastOf; ///< of the last character, by frame
    };

    osg::State& _state;
    std::vector<Group> _groups;
    std::size_t _frame = 0;
};

/// What a palette entry of a pose costs at most, see gpu_costs.md.
constexpr double bytesOfEntry = 256.0;

void measureSets(osg::State& state, bool isQuick, GpuPage& page)
{
    const PosePipeline::Options usual = PosePipeline::of(state)->options();
    const auto with = [&](PosePipeline::Form form, bool drawsTriangles)
    {
        PosePipeline::Options options = usual;
        options.form = form;
        options.drawsTriangles = drawsTriangles;
        return options;
    };
    const std::pair<const char*, PosePipeline::Options> variants[] = {
        {"the kit's choice", with(usual.form, true)},
        {"a draw a level, triangles", with(PosePipeline::Form::Fused, true)},
        {"a draw a level, points", with(PosePipeline::Form::Fused, false)},
        {"three draws", with(PosePipeline::Form::Separate, true)}};
    for (const auto& [sets, counts] : std::map<std::size_t, std::vector<std::size_t>>{
             {1, {1, 10, 100, 1000, 10000}}, {10, {1, 10, 100, 1000}}, {100, {1, 10, 100}}})
        for (const std::size_t characters : counts)
        {
            if (isQuick && sets * characters > 1000) continue;
            Groups groups(sets, characters, state);
            std::vector<Variant> steps;
            for (const auto& [name, options] : variants)
            {
                groups.step(options);
                groups.check();
                steps.push_back({name, [&groups, chosen = options] { groups.step(chosen); }});
            }
            page.race("pose, sets: " + std::to_string(sets), sets * characters, steps,
                      bytesOfEntry * static_cast<double>(groups.entryCount()));
        }
    PosePipeline::of(state)->options() = usual;
}

/// What a driver costs whose feedback does not work.
void measureFallback(osg::State& state, GpuPage& page)
{
    PosePipeline::Options& options = PosePipeline::of(state)->options();
    const PosePipeline::Options usual = options;
    PosePipeline::Options onCpu = usual;
    onCpu.form = PosePipeline::Form::Cpu;
    constexpr std::size_t characters = 1000;
    Groups groups(1, characters, state);
    groups.step(onCpu);
    groups.check();
    page.race("pose without feedback", characters,
              {{"the CPU twin alone", [&] { groups.computeByTwin(); }},
               {"in place of the passes", [&] { groups.step(onCpu); }}});
    options = usual;
}

/// Whole frames of a crowd with a pixel error.
void measureFields(const Subject& subject, bool isQuick, int rounds, double seconds, GpuPage& page)
{
    const struct
    {
        const char* name;
        osg::Vec3d eye;     ///< from the centre, in radii
        double fieldOfView; ///< degrees
    } views[] = {{"near", {0.0, -0.74, 0.06}, 30.0}, {"far", {0.0, -1.5, 2.7}, 30.0}};
    for (const std::size_t count : {1000, 10000, 100000})
    {
        if (isQuick && count > 1000) break;
        const osg::ref_ptr<AnimatedCrowd> sharing = makeCrowd(subject, count);
        taken(sharing->getMeshes().setPixelError(fieldPixelError));
        sharing->getMeshes().waitForLevels();
        const osg::ref_ptr<AnimatedCrowd> apart = osg::clone(sharing.get(), osg::CopyOp::SHALLOW_COPY);
        // Such instances keep controllers and have poses of their own.
        apart->setInstanceEventCallback([](AnimatedCrowd::Instance, const AnimationEvent&) {});
        apart->getMeshes().waitForLevels();
        const osg::BoundingSphere bound = sharing->getBound();
        Viewers viewers;
        for (const osg::ref_ptr<AnimatedCrowd>& crowd : {sharing, apart})
            viewers.push_back(std::make_unique<StagedViewer>(crowd, bound, 1280, 720));
        for (const auto& view : views)
        {
            std::vector<std::function<Spent()>> contestants;
            for (const auto& viewer : viewers)
            {
                viewer->lookFrom(bound.center() + view.eye * bound.radius(), bound.center(), view.fieldOfView);
                viewer->framesInARow(2); // compiles and allocates
                const double once = std::max(viewer->framesInARow(1).wall, 1e-6);
                const int frames = static_cast<int>(std::clamp(seconds / rounds / once, 1.0, 100.0));
                contestants.emplace_back([&viewer, frames] { return viewer->framesInARow(frames); });
            }
            const std::vector<Series> series = interleaved(rounds, contestants);
            for (const auto& viewer : viewers)
            {
                viewer->requireNoErrors();
                if (viewer->pixelsDrawn() < 4) throw std::runtime_error("a field is empty");
            }
            page.add("frame, " + subject.name + ", " + view.name, count, {"shared poses", "a pose each"}, series);
        }
    }
}

std::map<std::string, std::string> describeDevice(osg::State& state, double copySpeed)
{
    const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
    const auto yesOrNo = [](bool is) { return std::string(is ? "yes" : "no"); };
    const PosePipeline::Options& options = PosePipeline::of(state)->options();
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    return {{"GL renderer", text(GL_RENDERER)},
            {"GL version", text(GL_VERSION)},
            {"base instances", yesOrNo(FeedbackPass::canOffsetInstances(gl))},
            {"clock", yesOrNo(GpuClock(state).isThere())},
            {"texels of a buffer texture", std::to_string(options.maxTexels)},
            {"entries worth a draw", std::to_string(options.entriesWorthADraw)},
            {"copy, GB/s read and written", std::to_string(1e-9 * copySpeed)}};
}

} // namespace

void measureGpu(const std::vector<Subject>& subjects, Run& run)
{
    osg::State& state = *run.context.getState();
    const double seconds = run.isQuick ? 0.05 : 0.3; // of a variant
    const int rounds = run.isQuick ? 3 : 5;
    GpuPage page(state, rounds, seconds);
    constexpr double fast = 1e11; // bytes a second: a card with memory of its own
    page.copySpeed = copySpeedOf(state, std::size_t(1) << 24);
    if (page.copySpeed > fast) page.copySpeed = copySpeedOf(state, std::size_t(1) << 28);
    page.environment = describeDevice(state, page.copySpeed);
    measureSets(state, run.isQuick, page);
    measureFallback(state, page);
    const std::size_t largest = PosePipeline::of(state)->getMaxTexels() / texelsOfLayout;
    measureLayouts(state,
                   std::min<std::size_t>(largest, page.copySpeed > fast ? 20000
                                                  : run.isQuick         ? 300
                                                                        : 2000),
                   page);
    for (const std::size_t instances : {1000, 10000, 100000})
        measureUploads(state, instances, page);
    for (const Subject& subject : subjects)
        measureFields(subject, run.isQuick, run.isQuick ? 2 : 3, 2.0 * seconds, page);
    run.context.makeCurrent();
    requireNoGlErrors();
    page.print(std::cout);
    std::cout << "\n";
    if (!page.write(run.folder)) throw std::runtime_error("cannot write into " + run.folder);
}

} // namespace osgGpuAnimation::benchmark
