// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/CullFace>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace osgGpuAnimation::benchmark
{

namespace
{

// Of ARB_pipeline_statistics_query.
constexpr GLenum shaderInvocations = 0x82F0; ///< of vertices
constexpr GLenum primitivesClipped = 0x82F6;

/// distance: from the centre, in radii.
void lookFromTheAir(StagedViewer& viewer, const osg::BoundingSphere& field, double distance)
{
    const osg::Vec3d centre = field.center();
    viewer.lookFrom(centre + osg::Vec3d(0.0, -0.5, 0.9) * distance * field.radius(), centre, 30.0);
}

/// What a context has evaluated and uploaded: so far, or in a frame.
struct Counts
{
    double poses = 0.0, bytes = 0.0;

    static Counts soFar(StagedViewer& viewer)
    {
        osg::State& state = viewer.currentState();
        const PosePipeline::Counters& counters = PosePipeline::of(state)->getCounters();
        return {static_cast<double>(counters.instancesEvaluated),
                static_cast<double>(counters.bytesUploaded + PlacedInstanceBuffers::of(state).getBytesUploaded())};
    }
    static Counts ofFrame(StagedViewer& viewer, FrameCost* outCost = nullptr)
    {
        const Counts before = soFar(viewer);
        const FrameCost cost = viewer.frame();
        if (outCost) *outCost = cost;
        const Counts after = soFar(viewer);
        return {after.poses - before.poses, after.bytes - before.bytes};
    }
};

/// A count of GL's pipeline statistics over one frame, passes of poses included. The context has
/// ARB_pipeline_statistics_query.
double countedInFrame(StagedViewer& viewer, GLenum what)
{
    const osg::GLExtensions& gl = *viewer.currentState().get<osg::GLExtensions>();
    GLuint query = 0;
    gl.glGenQueries(1, &query);
    gl.glBeginQuery(what, query);
    viewer.frame();
    viewer.currentState();
    gl.glEndQuery(what);
    GLuint64 count = 0;
    gl.glGetQueryObjectui64v(query, GL_QUERY_RESULT, &count);
    gl.glDeleteQueries(1, &query);
    return static_cast<double>(count);
}

osg::ref_ptr<AnimatedCrowd> makeField(const Subject& subject, std::size_t step = 1)
{
    osg::ref_ptr<AnimatedCrowd> crowd = &Field(subject, step).node();
    taken(crowd->getMeshes().setPixelError(fieldPixelError));
    crowd->getMeshes().waitForLevels();
    return crowd;
}

} // namespace

void measureField(const Subject& subject, Run& run)
{
    const osg::ref_ptr<AnimatedCrowd> field = makeField(subject);
    const osg::BoundingSphere bound = field->getBound();
    Viewers viewers;
    viewers.push_back(std::make_unique<StagedViewer>(field, bound, 1280, 720));
    StagedViewer& viewer = *viewers.front();
    const auto add = [&](const char* what, const char* unit, const Figure& figure)
    { run.report.add(Row(subject.name, places, what, unit, figure)); };
    const double count = static_cast<double>(places), microseconds = 1e6 / count;
    lookAcross(viewer, bound);
    const Costs costs = race(viewers, run.rounds).front();
    const Counts counts = Counts::ofFrame(viewer);
    add("the field, whole frame", "µs an instance", figureOf(costs.whole, microseconds));
    add("the field, whole frame by the clock", "ms", figureOf(costs.whole, 1e3, &Spent::wall));
    add("the field, update + cull", "µs an instance", figureOf(costs.updateAndCull, microseconds));
    add("the field, poses evaluated", "a frame", figureOf(counts.poses));
    add("the field, uploaded", "bytes an instance", figureOf(counts.bytes / count));
    for (const auto& [what, distance] : {std::pair("the field, all in view, update + cull", 3.0),
                                         std::pair("the field, a tenth in view, update + cull", 0.62)})
    {
        lookFromTheAir(viewer, bound, distance);
        add(what, "µs an instance", figureOf(race(viewers, run.rounds).front().updateAndCull, microseconds));
    }
    lookAcross(viewer, bound);
    if (!osg::isGLExtensionOrVersionSupported(viewer.currentState().getContextID(), "GL_ARB_pipeline_statistics_query",
                                              4.6f))
        return;
    add("the field, triangles drawn", "a frame", figureOf(countedInFrame(viewer, primitivesClipped)));
    add("the field, vertices shaded, poses' too", "a frame", figureOf(countedInFrame(viewer, shaderInvocations)));
    viewer.requireNoErrors();
}

void measureMixed(const std::vector<Subject>& subjects, Run& run)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<Field> fields;
    const auto walk = [&](double way)
    {
        for (Field& field : fields)
            field.walk(way);
    };
    for (std::size_t kind = 0; kind < subjects.size(); ++kind)
    {
        fields.emplace_back(subjects[kind], subjects.size(), kind);
        taken(fields.back().node().getMeshes().setPixelError(fieldPixelError));
        fields.back().node().getMeshes().waitForLevels();
        root->addChild(&fields.back().node());
    }
    walk(0.0);
    StagedViewer viewer(root, root->getBound(), 1280, 720);
    std::vector<double> poses, bytes;
    Series whole, walks;
    const int frames = 8 * run.rounds;
    for (int frame = -3; frame < frames; ++frame)
    {
        // From one corner across the field to the opposite one, low above it.
        const double along = static_cast<double>(columns) * (frame + 3) / (frames + 3);
        viewer.lookFrom(osg::Vec3d(along, 0.8 * along - 10.0, 6.0), osg::Vec3d(along + 40.0, along + 50.0, 0.0), 40.0);
        const Stopwatch stopwatch;
        walk(0.02 * (frame + 3));
        const Spent walked = stopwatch.elapsed();
        if (frame < 0)
        {
            viewer.frame();
            continue;
        }
        FrameCost cost;
        const Counts counts = Counts::ofFrame(viewer, &cost);
        walks.push_back(walked);
        whole.push_back(cost.whole());
        poses.push_back(counts.poses);
        bytes.push_back(counts.bytes / static_cast<double>(places));
    }
    viewer.requireNoErrors();
    if (viewer.pixelsDrawn() < 4) throw std::runtime_error("an empty picture");
    const auto add = [&](const char* what, const char* unit, const Figure& figure)
    {
        run.report.add(Row(std::to_string(subjects.size()) + " kinds", places,
                           std::string("mixed field, flown through, ") + what, unit, figure));
    };
    add("whole frame", "ms", figureOf(whole, 1e3));
    add("placements set", "ms", figureOf(walks, 1e3));
    add("poses evaluated", "a frame", figureOf(poses));
    add("uploaded", "bytes an instance", figureOf(bytes));
}

void measureMemory(const Subject& subject, Run& run)
{
    // The triangles are thrown away: llvmpipe would keep them.
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT_AND_BACK),
                                                      osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    const osg::BoundingSphere sight = makeField(subject)->getBound();
    StagedViewer viewer(root, sight, 1280, 720);
    lookAcross(viewer, sight);
    double before = 0.0;
    for (const std::size_t step : {std::size_t(997), std::size_t(1)}) // with the set and its programs from the first
    {
        root->removeChildren(0, root->getNumChildren());
        viewer.frame();
        before = bytesInUse();
        root->addChild(makeField(subject, step));
        for (int frame = 0; frame < 3; ++frame)
            viewer.frame();
    }
    const double poses = Counts::ofFrame(viewer).poses;
    const double mebibytes = (bytesInUse() - before) / (1024.0 * 1024.0);
    viewer.requireNoErrors();
    if (poses < 1.0) throw std::runtime_error("no pose was evaluated");
    run.report.add(
        Row(subject.name, places, "the field, memory beyond the set, CPU and GPU", "MiB", figureOf(mebibytes))
            .atMost(64.0));
}

namespace
{

constexpr int across = 10; ///< instances of a row, and rows
constexpr int samples = 8; ///< of a pixel, in each direction
constexpr int window = 8;  ///< of the structural similarity, in pixels

/// Brightness in [0, 1] of square pixels, and the share of the samples that are drawn.
struct Picture
{
    int width;
    std::vector<double> brightness;
    double drawn;
};

/// The last frame; each pixel is the mean of as many samples in each direction.
Picture pictureOf(StagedViewer& viewer, int width, int samplesOfPixel)
{
    const std::vector<unsigned char> pixels = viewer.pixels();
    const std::size_t side = static_cast<std::size_t>(width) * static_cast<std::size_t>(samplesOfPixel);
    Picture picture{
        width, std::vector<double>(pixels.size() / 4 / static_cast<std::size_t>(samplesOfPixel * samplesOfPixel)), 0.0};
    for (std::size_t sample = 0; sample < pixels.size() / 4; ++sample)
    {
        const unsigned char* rgb = &pixels[4 * sample];
        const std::size_t x = sample % side / static_cast<std::size_t>(samplesOfPixel),
                          y = sample / side / static_cast<std::size_t>(samplesOfPixel);
        const double sum = rgb[0] + rgb[1] + rgb[2];
        picture.brightness[y * static_cast<std::size_t>(width) + x] +=
            sum / (3.0 * 255.0 * samplesOfPixel * samplesOfPixel);
        if (sum > 0.0) picture.drawn += 1.0 / static_cast<double>(pixels.size() / 4);
    }
    return picture;
}

/// The mean over all windows; 1: equal pictures.
double structuralSimilarity(const Picture& a, const Picture& b)
{
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03, count = window * window;
    const int height = static_cast<int>(a.brightness.size()) / a.width;
    double sum = 0.0;
    int windows = 0;
    for (int top = 0; top + window <= height; ++top)
        for (int left = 0; left + window <= a.width; ++left, ++windows)
        {
            double meanA = 0.0, meanB = 0.0, squaresA = 0.0, squaresB = 0.0, products = 0.0;
            for (int y = top; y < top + window; ++y)
                for (int x = left; x < left + window; ++x)
                {
                    const auto pixel = static_cast<std::size_t>(y * a.width + x);
                    const double ofA = a.brightness[pixel], ofB = b.brightness[pixel];
                    meanA += ofA / count;
                    meanB += ofB / count;
                    squaresA += ofA * ofA / count;
                    squaresB += ofB * ofB / count;
                    products += ofA * ofB / count;
                }
            const double covariance = products - meanA * meanB;
            const double variances = squaresA - meanA * meanA + squaresB - meanB * meanB;
            sum += (2.0 * meanA * meanB + c1) * (2.0 * covariance + c2) /
                   ((meanA * meanA + meanB * meanB + c1) * (variances + c2));
        }
    return sum / windows;
}

/// Instances on a wall, each with some clip, time and direction.
osg::ref_ptr<AnimatedCrowd> makeWall(const Subject& subject, double spacing)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*subject.model.character);
    std::mt19937 random(1);
    for (int place = 0; place < across * across; ++place)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        static_cast<void>(controller.play(random() % subject.set().clips().size()));
        controller.seek(1e-3 * static_cast<double>(random() % 1000) * controller.duration());
        const osg::Matrixd turned = osg::Matrixd::rotate(1e-3 * static_cast<double>(random() % 6283), 0.0, 0.0, 1.0);
        const double x = spacing * (place % across - 0.5 * across), z = spacing * (place / across - 0.5 * across);
        static_cast<void>(crowd->add(turned * osg::Matrixd::translate(x, 0.0, z), controller));
    }
    return crowd;
}

/// Of instances of that height in pixels: with the pixel error, and exact ones.
void comparePictures(const Subject& subject, int pixels, Report& report)
{
    const osg::BoundingBox box = subject.model.character->getClipBounds(-1);
    const double tall = box.zMax() - box.zMin(), spacing = 2.0 * tall;
    const int width = 2 * pixels * across;
    const osg::ref_ptr<AnimatedCrowd> wall = makeWall(subject, spacing);
    StagedViewer viewer(wall, wall->getBound(), samples * width);
    constexpr double fieldOfView = 10.0; // degrees
    const osg::Vec3d centre(-0.5 * spacing, 0.5 * (box.yMin() + box.yMax()),
                            0.5 * (box.zMin() + box.zMax()) - 0.5 * spacing);
    const double distance = 0.5 * across * spacing / std::tan(osg::DegreesToRadians(0.5 * fieldOfView));
    viewer.lookFrom(centre - osg::Vec3d(0.0, distance, 0.0), centre, fieldOfView);
    std::vector<Picture> pictures;
    for (const float error : {0.0f, samples * fieldPixelError})
    {
        taken(wall->getMeshes().setPixelError(error));
        wall->getMeshes().waitForLevels();
        for (int frame = 0; frame < 2; ++frame)
            viewer.frameAt(0.0);
        pictures.push_back(pictureOf(viewer, width, samples));
    }
    viewer.requireNoErrors();
    const auto row = [&](const std::string& what, double value)
    {
        return Row(subject.name, across * across, "pictures, " + what + ", " + std::to_string(pixels) + " pixels tall",
                   "%", figureOf(100.0 * value));
    };
    Row coverage = row("coverage", pictures[1].drawn / pictures[0].drawn);
    coverage.bar = "98 to 102 %";
    coverage.isMet = std::abs(coverage.ours.median - 100.0) <= 2.0;
    report.add(coverage);
    report.add(row("structural similarity", structuralSimilarity(pictures[0], pictures[1])).atLeast(98.0));
}

/// The mean brightness of the drawn pixels of each row; below 0 where few are drawn.
std::vector<double> brightnessOfRows(const Picture& picture)
{
    constexpr int minDrawn = 200; // pixels
    std::vector<double> rows;
    for (auto row = picture.brightness.begin(); row != picture.brightness.end(); row += picture.width)
    {
        const auto drawn = picture.width - std::count(row, row + picture.width, 0.0);
        rows.push_back(drawn < minDrawn ? -1.0
                                        : std::accumulate(row, row + picture.width, 0.0) / static_cast<double>(drawn));
    }
    return rows;
}

/// The largest change of brightness from some rows of the field to the next ones that the pixel error brings: a line
/// where levels change.
void compareRows(const Subject& subject, Report& report)
{
    constexpr std::size_t band = 8; // rows on each side
    constexpr int width = 1280, height = 720;
    const Field field(subject);
    const osg::BoundingSphere bound = field.node().getBound();
    StagedViewer viewer(&field.node(), bound, width, height);
    lookAcross(viewer, bound);
    std::vector<std::vector<double>> rows;
    for (const float error : {0.0f, fieldPixelError})
    {
        taken(field.node().getMeshes().setPixelError(error));
        field.node().getMeshes().waitForLevels();
        viewer.frameAt(0.0);
        rows.push_back(brightnessOfRows(pictureOf(viewer, width, 1)));
    }
    viewer.requireNoErrors();
    std::vector<double> ratios;
    for (std::size_t row = 0; row < rows[0].size(); ++row)
        if (rows[0][row] > 0.0 && rows[1][row] > 0.0) ratios.push_back(rows[1][row] / rows[0][row]);
    if (ratios.size() < 2 * band)
        throw std::runtime_error("the field's picture has " + std::to_string(ratios.size()) + " rows");
    double largest = 0.0;
    for (auto at = ratios.begin() + band; at + band <= ratios.end(); ++at)
        largest = std::max(largest,
                           std::abs(std::accumulate(at, at + band, 0.0) / std::accumulate(at - band, at, 0.0) - 1.0));
    report.add(
        Row(subject.name, places, "pictures, the field's largest step of brightness", "%", figureOf(100.0 * largest))
            .atMost(2.0));
}

} // namespace

void measurePictures(const Subject& subject, Run& run)
{
    for (const int pixels : {4, 8, 16})
        comparePictures(subject, pixels, run.report);
    compareRows(subject, run.report);
}

} // namespace osgGpuAnimation::benchmark
