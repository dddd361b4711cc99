// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/CullFace>

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

} // namespace osgGpuAnimation::benchmark
