// SPDX-License-Identifier: MIT
#include "tool/RenderCommand.h"

#include "tool/CpuPoseEvaluator.h"
#include "tool/ModelFile.h"
#include "tool/ProgressLine.h"

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <vector>

namespace osgGpuAnimation::tool
{

namespace
{

/// Pauses the clip at the time, which loops as in the viewer.
void showTime(AnimationController& controller, double time)
{
    const double duration = controller.duration();
    const double rest = duration > 0.0 ? std::fmod(time, duration) : 0.0;
    controller.pause();
    controller.seek(rest < 0.0 ? rest + duration : rest);
}

/// The vertices of all plain geometry.
void addStill(const gltf::ImportedModel& model, std::vector<osg::Vec3d>& points)
{
    for (const gltf::ImportedPrimitive& primitive : model.primitives)
    {
        const auto* positions = dynamic_cast<const osg::Vec3Array*>(primitive.geometry->getVertexArray());
        if (!positions || dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get())) continue;
        const osg::Matrixd toWorld = primitive.toModel * model.fileToNode;
        for (const osg::Vec3& position : *positions)
            points.push_back(osg::Vec3d(position) * toWorld);
    }
}

/// The vertices of the character in its current pose.
void addMoving(const gltf::ImportedModel& model, CpuPoseEvaluator& evaluator, std::vector<osg::Vec3d>& points)
{
    const osg::MatrixList places = model.character->getWorldMatrices();
    const Result<EvaluatedPose> pose = evaluator.evaluate(model.character->getController().instruction(), {});
    if (!pose || places.empty()) return;
    for (const std::vector<glm::dvec3>& positions : pose.value().positions)
        for (const glm::dvec3& position : positions)
            points.push_back(osg::Vec3d(position.x, position.y, position.z) * model.fileToNode * places.front());
}

/// The points that the pictures must show: every vertex at every time, or at 64 times, spread evenly, if there are
/// more.
std::vector<osg::Vec3d> pointsOf(const gltf::ImportedModel& model, const std::vector<double>& times)
{
    std::vector<osg::Vec3d> points;
    addStill(model, points);
    if (!model.character) return points;
    CpuPoseEvaluator evaluator(model);
    const std::size_t looks = std::min<std::size_t>(times.size(), 64);
    for (std::size_t look = 0; look < looks; ++look)
    {
        showTime(model.character->getController(), times[look * times.size() / looks]);
        addMoving(model, evaluator, points);
    }
    return points;
}

std::string numbered(const std::string& output, std::size_t number)
{
    const std::filesystem::path path(output);
    std::ostringstream name;
    name << path.stem().string() << "." << std::setw(4) << std::setfill('0') << number << path.extension().string();
    return (path.parent_path() / name.str()).string();
}

} // namespace

Result<bool> RenderCommand::run() const
{
    gltf::ImportOptions options;
    options.clip = clip;
    options.camera = camera;
    options.variant = variant;
    options.noKeys = true; // no window, no keyboard
    const Result<gltf::ImportedModel> model = readModel(file, options);
    if (!model) return Error{file + ": " + model.error().message};
    Result<std::unique_ptr<PictureViewer>> viewer = PictureViewer::create(width, height, look);
    if (!viewer) return Error{file + ": " + viewer.error().message};
    std::vector<double> times;
    for (int frame = 0; frame < frames.value_or(1); ++frame)
        times.push_back(time + frame / framesPerSecond);
    viewer.value()->show(model.value().root, pointsOf(model.value(), times));
    if (model.value().startCamera) viewer.value()->lookThrough(*model.value().startCamera);

    ProgressLine progress("drawing");
    for (std::size_t frame = 0; frame < times.size(); ++frame)
    {
        progress.set(frame, times.size());
        if (model.value().character) showTime(model.value().character->getController(), times[frame]);
        const osg::ref_ptr<osg::Image> image = viewer.value()->draw(times[frame] - time);
        if (!image) return Error{file + ": OpenGL reported an error while drawing"};
        const std::string name = frames ? numbered(output, frame + 1) : output;
        // writeImageFile() would print an error of its own.
        if (!osgDB::Registry::instance()->writeImage(*image, name, nullptr).success())
            return Error{name + ": cannot be written"};
    }
    return true;
}

} // namespace osgGpuAnimation::tool
