// SPDX-License-Identifier: MIT
#include "tool/PoseCommand.h"

#include "gltf/file/ProgressLine.h"
#include "gltf/file/SavedFile.h"

#include <osgGpuAnimation/animation/AnimationController.h>

#include <algorithm>
#include <iostream>
#include <memory>

namespace osgGpuAnimation::tool
{

namespace
{

/// The set's clip for the request, -1 for none.
Result<int> findClip(const gltf::ImportedModel& model, const PoseRequest& request)
{
    if (request.animation)
    {
        const auto& numbers = model.animationOfClip;
        const auto found = std::find(numbers.begin(), numbers.end(), *request.animation);
        if (found == numbers.end())
            return Error{"animations[" + std::to_string(*request.animation) + "]: there is no such clip"};
        return static_cast<int>(found - numbers.begin());
    }
    // The import has found the clip by its name, or refused the file, and plays it.
    return request.bind || !model.character ? -1 : model.character->getController().clip();
}

/// glTF's clips hold at their ends; they do not loop.
PoseInstruction instructionAt(const gltf::ImportedModel& model, int clip, double time)
{
    AnimationController controller(model.set);
    controller.setLoopMode(LoopMode::Once);
    if (clip < 0 || !controller.play(static_cast<std::size_t>(clip))) return PoseInstruction();
    controller.seek(time);
    return controller.instruction();
}

/// The palette entries of the weights that the request sets.
Result<std::vector<FixedEntry>> fixedEntries(const gltf::ImportedModel& model, const PoseRequest& request)
{
    std::vector<FixedEntry> entries;
    for (const PoseRequest::FixedWeights& fixed : request.fixedWeights)
    {
        const std::string name = "fixedWeights of node " + std::to_string(fixed.node);
        if (!model.set) return Error{name + ": nothing in the file can move"};
        const std::vector<MorphWeights>& morphs = model.set->morphs();
        const auto morph = std::find_if(morphs.begin(), morphs.end(),
                                        [&](const MorphWeights& weights) { return weights.sourceNode == fixed.node; });
        if (morph == morphs.end()) return Error{name + ": its mesh has no morph targets"};
        if (morph->defaults.size() != fixed.weights.size())
            return Error{name + ": " + std::to_string(fixed.weights.size()) + " weights, expected " +
                         std::to_string(morph->defaults.size())};
        const int first = model.set->entryOfMorph(static_cast<std::size_t>(morph - morphs.begin()));
        for (std::size_t block = 0; block < morph->blockCount(); ++block)
        {
            FixedEntry entry{static_cast<std::size_t>(first) + block, {}};
            for (std::size_t place = 0; place < MorphWeights::weightsPerBlock; ++place)
            {
                const std::size_t weight = block * MorphWeights::weightsPerBlock + place;
                entry.value.rows[place / 4][static_cast<glm::length_t>(place % 4)] =
                    weight < fixed.weights.size() ? static_cast<float>(fixed.weights[weight]) : 0.0f;
            }
            entries.push_back(entry);
        }
    }
    return entries;
}

Result<std::string> evaluate(const gltf::ImportedModel& model, const PoseRequest& request, const PoseCommand& command)
{
    const Result<int> clip = findClip(model, request);
    if (!clip) return clip.error();
    const Result<std::vector<FixedEntry>> fixed = fixedEntries(model, request);
    if (!fixed) return fixed.error();
    std::unique_ptr<PoseEvaluator> evaluator;
    if (model.set)
    {
        const bool onGpu = command.evaluator == PoseCommand::Evaluator::Gpu;
        Result<std::unique_ptr<PoseEvaluator>> made = onGpu ? gpuPoseEvaluator(model) : cpuPoseEvaluator(model);
        if (!made) return made.error();
        evaluator = std::move(made).value();
    }
    Result<PoseDocument> document = PoseDocument::create(model, request, clip.value(), command.file,
                                                         evaluator ? evaluator->name() : "osggpuanim, nothing moves");
    if (!document) return document.error();
    PoseDocument poses = std::move(document).value();
    gltf::ProgressLine progress("computing poses");
    for (std::size_t frame = 0; frame < request.times.size(); ++frame)
    {
        const double time = request.times[frame];
        progress.set(frame, request.times.size());
        Result<EvaluatedPose> pose = EvaluatedPose();
        if (evaluator) pose = evaluator->evaluate(instructionAt(model, clip.value(), time), fixed.value());
        if (!pose) return pose.error();
        poses.add(time, pose.value());
    }
    return poses.text();
}

Error named(const std::string& file, const Error& error)
{
    return {file + ": " + error.message};
}

} // namespace

Result<void> PoseCommand::run() const
{
    PoseRequest wanted = request;
    if (!like.empty())
    {
        Result<PoseRequest> read = readPoseRequest(like);
        if (!read) return named(like, read.error());
        wanted = read.value();
    }
    if (wanted.bind && wanted.times.empty()) wanted.times = {0.0};
    const Result<gltf::ImportOptions> given = importOptions(*this);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    options.noRotation = true;
    options.clip = wanted.clip;
    const Result<gltf::ImportedModel> model = readModel(file, options);
    if (!model) return named(file, model.error());
    printClipWarnings(file, model.value().messages);
    const Result<std::string> text = evaluate(model.value(), wanted, *this);
    if (!text) return named(file, text.error());

    if (output.empty())
        return std::cout << text.value() << std::flush ? Result<void>() : Error{"standard output: cannot be written"};
    const Result<void> saved = gltf::saveFile(output, text.value());
    return saved ? saved : named(output, saved.error());
}

} // namespace osgGpuAnimation::tool
