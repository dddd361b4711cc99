// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Field.h"
#include "Measurements.h"
#include "PoseCrowd.h"

#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/CullFace>

#include <algorithm>
#include <iostream>

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

/// What the context has evaluated and uploaded so far.
struct Counts
{
    explicit Counts(StagedViewer& viewer)
    {
        viewer.makeCurrent();
        const PosePipeline::Counters& counters = PosePipeline::of(viewer.state())->getCounters();
        poses = static_cast<double>(counters.instancesEvaluated);
        bytes =
            static_cast<double>(counters.bytesUploaded + PlacedInstanceBuffers::of(viewer.state()).getBytesUploaded());
    }

    double poses, bytes;
};

/// A count of GL's pipeline statistics over one frame, passes of poses included. The context has
/// ARB_pipeline_statistics_query.
double countedInFrame(Contestant& contestant, GLenum what)
{
    StagedViewer& viewer = *contestant.viewer;
    viewer.makeCurrent();
    const osg::GLExtensions& gl = *viewer.state().get<osg::GLExtensions>();
    GLuint query = 0;
    gl.glGenQueries(1, &query);
    gl.glBeginQuery(what, query);
    contestant.frame();
    viewer.makeCurrent();
    gl.glEndQuery(what);
    GLuint64 count = 0;
    gl.glGetQueryObjectui64v(query, GL_QUERY_RESULT, &count);
    gl.glDeleteQueries(1, &query);
    return static_cast<double>(count);
}

/// Every so many places of a field belong to one kind; neighbours are 1 unit apart.
class MixedCrowd
{
public:
    MixedCrowd(const Subject& subject, std::size_t first, std::size_t step)
        : _first(first), _step(step), _scale(1.0 / spacingOf(subject)),
          _crowd(new AnimatedCrowd(*subject.model.character))
    {
        for (std::size_t place = first; place < places; place += step)
        {
            AnimationController controller(_crowd->getSharedAnimationSet());
            static_cast<void>(controller.play(place / step % subject.set().clips().size()));
            controller.seek(phaseOf(place, controller.duration()));
            if (const auto added = _crowd->add(placement(place, 0.0), controller)) _instances.push_back(added.value());
        }
    }

    /// Everyone has walked that far along y.
    void walk(double way)
    {
        for (std::size_t i = 0; i < _instances.size(); ++i)
            static_cast<void>(_crowd->setPlacement(_instances[i], placement(_first + i * _step, way)));
    }

    AnimatedCrowd& node() const { return *_crowd; }

private:
    osg::Matrixd placement(std::size_t place, double way) const
    {
        return osg::Matrixd::scale(_scale, _scale, _scale) *
               osg::Matrixd::translate(static_cast<double>(place % columns), static_cast<double>(place / columns) + way,
                                       0.0);
    }

    std::size_t _first, _step;
    double _scale;
    osg::ref_ptr<AnimatedCrowd> _crowd;
    std::vector<AnimatedCrowd::Instance> _instances;
};

/// The bytes that a field adds to a viewer's process that has the set and its programs. The triangles are thrown away:
/// llvmpipe would keep them.
Result<double> bytesOfField(const Subject& subject, double& outPoses)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT_AND_BACK),
                                                      osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    const osg::BoundingSphere sight = makeField(subject)->getBound();
    Result<Contestant> made = contestant(root, sight, 1280, 720);
    if (!made) return made.error();
    Contestant viewing = made.value();
    StagedViewer& viewer = *viewing.viewer;
    lookAcross(viewer, sight);
    double before = 0.0;
    for (const std::size_t step : {std::size_t(997), std::size_t(1)})
    {
        root->removeChildren(0, root->getNumChildren());
        viewing.frame();
        before = bytesInUse();
        const osg::ref_ptr<AnimatedCrowd> field = makeField(subject, step);
        if (const Result<void> set = field->getMeshes().setPixelError(fieldPixelError); !set) return set.error();
        root->addChild(field);
        for (int frame = 0; frame < 3; ++frame)
            viewing.frame();
    }
    const Counts counts(viewer);
    viewing.frame();
    const double bytes = bytesInUse() - before;
    outPoses = Counts(viewer).poses - counts.poses;
    if (const std::string errors = viewer.takeErrors(); !errors.empty()) return Error{"GL reports " + errors};
    if (outPoses < 1.0) return Error{"no pose was evaluated"};
    return bytes;
}

} // namespace

Result<void> measureField(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": a field of " << places << std::endl;
    const osg::ref_ptr<AnimatedCrowd> field = makeField(subject);
    if (const Result<void> set = field->getMeshes().setPixelError(fieldPixelError); !set) return set.error();
    const osg::BoundingSphere bound = field->getBound();
    Result<Contestant> made = contestant(field, bound, 1280, 720);
    if (!made) return made.error();
    std::vector<Contestant> contestants{std::move(made.value())};
    StagedViewer& viewer = *contestants.front().viewer;
    lookAcross(viewer, bound);
    race(contestants, effort.rounds);
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    const Counts before(viewer);
    contestants.front().frame();
    const Counts after(viewer);
    const double count = static_cast<double>(places);
    const auto addRow = [&](const char* what, const char* unit, std::vector<double> values)
    {
        Row row = named({}, subject, places, what, unit, "");
        row.ours = figureOf(std::move(values));
        report.add(row);
    };
    const auto microseconds = [&](const Series& series)
    {
        std::vector<double> each;
        for (const Spent& spent : series)
            each.push_back(1e6 * spent.cpu / count);
        return each;
    };
    addRow("the field, whole frame", "µs an instance", microseconds(contestants.front().whole));
    std::vector<double> byTheClock;
    for (const Spent& spent : contestants.front().whole)
        byTheClock.push_back(1e3 * spent.wall);
    addRow("the field, whole frame by the clock", "ms", std::move(byTheClock));
    addRow("the field, update + cull", "µs an instance", microseconds(contestants.front().updateAndCull));
    addRow("the field, poses evaluated", "a frame", {after.poses - before.poses});
    addRow("the field, uploaded", "bytes an instance", {(after.bytes - before.bytes) / count});
    const std::pair<const char*, double> views[] = {{"the field, all in view, update + cull", 3.0},
                                                    {"the field, a tenth in view, update + cull", 0.62}};
    for (const auto& [what, distance] : views)
    {
        lookFromTheAir(viewer, bound, distance);
        contestants.front().updateAndCull.clear();
        race(contestants, effort.rounds);
        addRow(what, "µs an instance", microseconds(contestants.front().updateAndCull));
    }
    lookAcross(viewer, bound);
    if (!osg::isGLExtensionOrVersionSupported(viewer.state().getContextID(), "GL_ARB_pipeline_statistics_query", 4.6f))
        return {};
    addRow("the field, triangles drawn", "a frame", {countedInFrame(contestants.front(), primitivesClipped)});
    addRow("the field, vertices shaded, poses' too", "a frame",
           {countedInFrame(contestants.front(), shaderInvocations)});
    if (const std::string errors = viewer.takeErrors(); !errors.empty()) return Error{"GL reports " + errors};
    return {};
}

Result<void> measureMixed(const std::vector<Subject>& subjects, const Effort& effort, Report& report)
{
    std::cerr << "a field of " << places << " of " << subjects.size() << " kinds" << std::endl;
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<MixedCrowd> crowds;
    for (std::size_t kind = 0; kind < subjects.size(); ++kind)
    {
        crowds.emplace_back(subjects[kind], kind, subjects.size());
        if (const Result<void> set = crowds.back().node().getMeshes().setPixelError(fieldPixelError); !set)
            return set.error();
        root->addChild(&crowds.back().node());
    }
    Result<Contestant> made = contestant(root, root->getBound(), 1280, 720);
    if (!made) return made.error();
    std::vector<Contestant> contestants{std::move(made.value())};
    StagedViewer& viewer = *contestants.front().viewer;
    std::vector<double> cpu, moving, poses, bytes;
    const int frames = 8 * effort.rounds;
    for (int frame = -3; frame < frames; ++frame)
    {
        // From one corner across the field to the opposite one, low above it.
        const double along = static_cast<double>(columns) * (frame + 3) / (frames + 3);
        viewer.lookFrom(osg::Vec3d(along, 0.8 * along - 10.0, 6.0), osg::Vec3d(along + 40.0, along + 50.0, 0.0), 40.0);
        const Stopwatch walk;
        for (MixedCrowd& crowd : crowds)
            crowd.walk(0.02 * (frame + 3));
        const double walked = walk.elapsed().cpu;
        if (frame < 0)
        {
            contestants.front().frame();
            continue;
        }
        const Counts before(viewer);
        cpu.push_back(1e3 * contestants.front().frame().whole().cpu);
        const Counts after(viewer);
        moving.push_back(1e3 * walked);
        poses.push_back(after.poses - before.poses);
        bytes.push_back((after.bytes - before.bytes) / static_cast<double>(places));
    }
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    const auto addRow = [&](const char* what, const char* unit, std::vector<double> values)
    {
        Row row;
        row.subject = std::to_string(subjects.size()) + " kinds";
        row.count = places;
        row.what = std::string("mixed field, flown through, ") + what;
        row.unit = unit;
        row.ours = figureOf(std::move(values));
        report.add(row);
    };
    addRow("whole frame", "ms", std::move(cpu));
    addRow("placements set", "ms", std::move(moving));
    addRow("poses evaluated", "a frame", std::move(poses));
    addRow("uploaded", "bytes an instance", std::move(bytes));
    return {};
}

Result<void> measureMemory(const Subject& subject, const Effort&, Report& report)
{
    std::cerr << subject.name << ": memory of a field" << std::endl;
    double poses = 0.0;
    const Result<double> bytes = bytesOfField(subject, poses);
    if (!bytes) return bytes.error();
    std::cerr << subject.name << ": " << poses << " poses a frame" << std::endl;
    const double mebibytes = bytes.value() / (1024.0 * 1024.0);
    report.add(limited(figureOf({mebibytes}), 64.0, "≤ 64 MiB", subject, places,
                       "the field, memory beyond the set, CPU and GPU", "MiB"));
    return {};
}

} // namespace osgGpuAnimation::benchmark
