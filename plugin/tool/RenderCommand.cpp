// SPDX-License-Identifier: MIT
#include "tool/Commands.h"

#include "crowd/CrowdGrid.h"
#include "gltf/export/PictureWriter.h"
#include "gltf/file/SavedFile.h"
#include "tool/PoseEvaluator.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/studio/ModelExtent.h>

#include <osg/BoundingBox>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <sstream>

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
void addMoving(const gltf::ImportedModel& model, const PoseEvaluator& evaluator, std::vector<osg::Vec3d>& points)
{
    const osg::MatrixList places = model.character->getWorldMatrices();
    const Result<EvaluatedPose> pose = evaluator.evaluate(model.character->getController().instruction());
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
    const PoseEvaluator evaluator = cpuPoseEvaluator(model);
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

Result<void> writePicture(const osg::Image* image, const std::string& file, const std::string& name)
{
    if (!image) return Error{file + ": OpenGL reported an error while drawing"};
    const Result<std::string> png = gltf::encodePng(*image);
    if (!png) return Error{name + ": " + png.error().message};
    const Result<void> saved = gltf::saveFile(name, png.value());
    return saved ? saved : Error{name + ": " + saved.error().message};
}

/// Surroundings of the panorama in that file. Only Radiance HDR has a reader that does not trust it.
Result<osg::ref_ptr<Environment>> readSurroundings(const std::string& name)
{
    if (osgDB::getLowerCaseFileExtension(name) == "hdr") return Environment::fromFile(name);
    if (!osgDB::fileExists(name)) return Error{name + ": there is no such file"};
    // readImageFile() would print an error of its own.
    osgDB::ReaderWriter::ReadResult read = osgDB::Registry::instance()->readImage(name, nullptr);
    if (!read.validImage()) return Error{name + ": not a picture that OSG's plugins read"};
    osg::ref_ptr<Environment> surroundings = new Environment;
    const Result<void> taken = surroundings->setPanorama(read.getImage());
    if (!taken) return Error{name + ": " + taken.error().message};
    return surroundings;
}

/// The ends of a cylinder with a vertical axis around the points: what they fill while they turn about it.
std::vector<osg::Vec3d> turned(const std::vector<osg::Vec3d>& points)
{
    osg::BoundingBoxd box;
    for (const osg::Vec3d& point : points)
        box.expandBy(point);
    double radius = 0.0;
    for (const osg::Vec3d& point : points)
        radius = std::max(radius, std::hypot(point.x() - box.center().x(), point.y() - box.center().y()));
    std::vector<osg::Vec3d> ends;
    constexpr int corners = 64;
    for (int corner = 0; corner < corners; ++corner)
        for (const double height : {box.zMin(), box.zMax()})
        {
            const double angle = 2.0 * osg::PI * corner / corners;
            ends.emplace_back(box.center().x() + radius * std::cos(angle), box.center().y() + radius * std::sin(angle),
                              height);
        }
    return ends;
}

/// Seconds, by picture.
std::vector<double> timesOf(const RenderCommand& command)
{
    std::vector<double> times(static_cast<std::size_t>(command.turntable.value_or(0)), command.time);
    for (int frame = 0; !command.turntable && frame < command.frames.value_or(1); ++frame)
        times.push_back(command.time + frame / command.framesPerSecond);
    return times;
}

/// points: of the scene, at all times. Error: there are none.
Result<void> show(const RenderCommand& command, PictureViewer& viewer, osg::Node& scene,
                  const std::vector<osg::Vec3d>& points, const std::optional<ViewDirection>& from)
{
    if (points.empty())
        return Error{command.file + ": there is nothing to draw; a file of clips needs a model, see --clips"};
    viewer.show(&scene, command.turntable ? turned(points) : points, from);
    return {};
}

/// simulationTime: of the viewer, from a picture's time; called before the picture is drawn.
Result<void> drawPictures(const RenderCommand& command, PictureViewer& viewer,
                          const std::function<double(double)>& simulationTime)
{
    const std::vector<double> times = timesOf(command);
    for (std::size_t picture = 0; picture < times.size(); ++picture)
    {
        if (command.turntable) viewer.turn(360.0 * static_cast<double>(picture) / *command.turntable);
        const osg::ref_ptr<osg::Image> image = viewer.draw(simulationTime(times[picture]));
        const std::string name =
            command.frames || command.turntable ? numbered(command.output, picture + 1) : command.output;
        if (const Result<void> written = writePicture(image, command.file, name); !written) return written;
    }
    return {};
}

Result<void> drawModel(const RenderCommand& command, PictureViewer& viewer, const gltf::ImportedModel& model)
{
    const std::vector<double> posed = command.turntable ? std::vector<double>{command.time} : timesOf(command);
    if (const Result<void> shown = show(command, viewer, *model.root, pointsOf(model, posed), command.view); !shown)
        return shown;
    if (model.character) model.character->getMeshes().waitForLevels();
    if (model.startCamera) viewer.lookThrough(*model.startCamera);
    return drawPictures(command, viewer,
                        [&](double seconds)
                        {
                            if (model.character) showTime(model.character->getController(), seconds);
                            return seconds - command.time;
                        });
}

Result<void> drawCrowd(const RenderCommand& command, PictureViewer& viewer, osg::Node& model,
                       const crowd::CrowdOptions& grid)
{
    const Result<osg::ref_ptr<AnimatedCrowd>> crowd = crowd::makeCrowd(model, grid);
    if (!crowd) return Error{grid.modelFile + ": " + crowd.error().message};
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(crowd.value());
    const std::vector<osg::Vec3d> points = osgGpuAnimation::pointsOf(*scene);
    const ViewDirection from = command.view.value_or(fillingDirection(points));
    if (const Result<void> shown = show(command, viewer, *scene, points, from); !shown) return shown;
    crowd.value()->getMeshes().waitForLevels();
    viewer.draw(0.0); // the time from which the clips run
    return drawPictures(command, viewer, [](double seconds) { return seconds; });
}

} // namespace

Result<void> RenderCommand::run() const
{
    const bool isCrowd = osgDB::getLowerCaseFileExtension(file) == "crowd";
    const Result<crowd::CrowdOptions> wanted =
        isCrowd ? crowd::parseCrowd(osgDB::getNameLessExtension(file), "") : crowd::CrowdOptions();
    if (!wanted) return Error{file + ": " + wanted.error().message};
    crowd::CrowdOptions grid = wanted.value();
    const Result<gltf::ImportOptions> given = importOptions(*this);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    options.camera = camera;
    options.variant = variant;
    options.noLights = look != Look::File;
    options.noKeys = true; // no window, no keyboard
    if (!isCrowd)
        options.clip = clip;
    else if (clip)
        grid.clips = {*clip};
    grid.outfits = outfits;
    const std::string modelFile = isCrowd ? grid.modelFile : file;
    const Result<gltf::ImportedModel> model = readModel(modelFile, options);
    if (!model) return Error{modelFile + ": " + model.error().message};
    if (!outfits.empty() && !isCrowd) return Error{file + ": outfits are for crowds, like " + file + ".20x20.crowd"};
    printWarnings(modelFile, model.value().messages);
    if (look == Look::File && model.value().lights.empty())
        std::cerr << "osggpuanim: " << modelFile << ": the file has no lights; only a faint surrounding lights it"
                  << std::endl;
    const Result<osg::ref_ptr<Environment>> surroundings =
        environment.empty() ? osg::ref_ptr<Environment>(new Environment) : readSurroundings(environment);
    if (!surroundings) return surroundings.error();
    Result<std::unique_ptr<PictureViewer>> viewer = PictureViewer::create(width, height, look, surroundings.value());
    if (!viewer) return Error{file + ": " + viewer.error().message};
    return isCrowd ? drawCrowd(*this, *viewer.value(), *model.value().root, grid)
                   : drawModel(*this, *viewer.value(), model.value());
}

} // namespace osgGpuAnimation::tool
