// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/crowd/SharedPoses.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/mesh/PaletteEntryBounds.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

/// The errors of a band have one level of detail, as without shared poses; the rest of the error is for poses. A band is
/// an eighth of the errors between two powers of two: its number is the upper bits of a float.
constexpr std::uint32_t bitsInBand = 20;
constexpr std::size_t bandCount = std::size_t(1) << (31 - bitsInBand);

/// Errors that allow nothing are in band 0.
std::size_t bandOf(float error)
{
    if (!(error > 0.0f && error < std::numeric_limits<float>::infinity())) return 0;
    std::uint32_t bits;
    std::memcpy(&bits, &error, sizeof(bits));
    return bits >> bitsInBand;
}

/// 0 for band 0.
float leastErrorOf(std::size_t band)
{
    const std::uint32_t bits = static_cast<std::uint32_t>(band) << bitsInBand;
    float error;
    std::memcpy(&error, &bits, sizeof(error));
    return error;
}

} // namespace

/// The instances of one camera, by level, and the batches with their poses, each pose once.
class SharedPoses::Collection
{
public:
    /// mostPoses: of a batch.
    Collection(const Meshes& meshes, const CrowdInstances& instances, const LodScale& scale, PoseFrame& frame,
               std::size_t mostPoses)
        : _meshes(meshes), _instances(instances), _scale(scale), _frame(frame), _mostPoses(mostPoses),
          _poses(posesOfThread()), _drawn(drawnOfThread())
    {
        const std::size_t needed = (meshes.travels.size() + 1) * posesPerClip;
        if (_poses.size() < needed) _poses.resize(needed, none);
    }
    ~Collection()
    {
        for (const std::uint32_t place : _used)
            _poses[place] = none;
        for (auto& [level, drawn] : _drawn)
            drawn.clear();
    }

    std::size_t batchCount() const { return _batches.size(); }
    std::unique_ptr<PoseBatch> takeBatch(std::size_t batch) { return std::move(_batches[batch]); }

    /// Adds the instance with a pose near its own. False: the instance needs a pose of its own.
    bool add(std::uint32_t index)
    {
        const glm::vec4& sphere = _instances.sphere(index);
        const float error = _scale.allowedError(glm::vec3(sphere), sphere.w, _instances.scale(index));
        const Band& band = bandFor(error);
        const std::uint32_t pose = poseOf(index, error - band.ofLevel);
        if (pose == none) return false;
        band.drawn->push_back({pose, index});
        return true;
    }

    /// Writes the list of a batch, level by level. function(level, first, count)
    template <typename Function>
    void write(std::size_t batch, std::vector<PlacedInstances::Drawn>& out, Function function) const
    {
        std::size_t count = 0;
        for (const auto& [level, drawn] : _drawn)
            count += drawn.size();
        out.reserve(count / _batches.size());
        for (const auto& [level, drawn] : _drawn)
        {
            const std::size_t first = out.size();
            if (_batches.size() == 1)
                out.insert(out.end(), drawn.begin(), drawn.end());
            else
                for (const auto& [pose, instance] : drawn)
                    if (pose / _mostPoses == batch)
                        out.push_back({static_cast<std::uint32_t>(pose % _mostPoses), instance});
            if (out.size() > first) function(level, first, out.size() - first);
        }
    }

private:
    static constexpr std::size_t posesPerClip = mostPhases + 1;
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    struct Band
    {
        std::vector<PlacedInstances::Drawn>* drawn;
        float ofLevel; ///< the error of the level of detail
    };

    /// By clip and phase; all `none` between two collections.
    static std::vector<std::uint32_t>& posesOfThread()
    {
        static thread_local std::vector<std::uint32_t> poses;
        return poses;
    }

    /// Poses are numbered through all batches.
    using DrawnByLevel = std::map<int, std::vector<PlacedInstances::Drawn>>;
    /// Without instances between two collections; keeps its storage.
    static DrawnByLevel& drawnOfThread()
    {
        static thread_local DrawnByLevel drawn;
        return drawn;
    }

    const Band& bandFor(float error)
    {
        const std::size_t number = bandOf(error);
        std::optional<Band>& band = _bands[number];
        if (!band)
        {
            const int level = _scale.levelWithin(leastErrorOf(number));
            band = Band{&_drawn[level], level == LodLevels::allTriangles ? 0.0f : std::ldexp(1.0f, level)};
        }
        return *band;
    }

    /// The pose of the roundest phase within the error. none: no phase is within it.
    std::uint32_t poseOf(std::uint32_t index, float error)
    {
        const int clip = _instances.clip(index);
        if (clip < 0) return poseAt(0, nullptr, 0);
        const ClipTravel& travel = _meshes.travels[static_cast<std::size_t>(clip)];
        std::uint32_t phase = 0;
        if (travel.length() > 0.0f)
        {
            const double duration = _meshes.durations[static_cast<std::size_t>(clip)];
            const float phases = static_cast<float>(mostPhases) / travel.length();
            const float at = travel.at(static_cast<float>(_instances.time(index, duration)));
            const float first = std::max(std::ceil((at - error) * phases), 0.0f);
            const float last = std::min(std::floor((at + error) * phases), static_cast<float>(mostPhases));
            if (!(first <= last)) return none;
            phase = roundest(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
        }
        return poseAt(static_cast<std::size_t>(clip) + 1, &travel, phase);
    }

    /// The number of most zeros at its end in binary, in [first, last]: the more instances choose it, the fewer poses.
    static std::uint32_t roundest(std::uint32_t first, std::uint32_t last)
    {
        if (first == 0) return 0;
        std::uint32_t mask = (first - 1) ^ last; // all bits from the highest one that differs
        for (const int shift : {1, 2, 4, 8, 16})
            mask |= mask >> shift;
        return last & ~(mask >> 1);
    }

    /// clip: its number + 1; 0: the rest pose.
    std::uint32_t poseAt(std::size_t clip, const ClipTravel* travel, std::uint32_t phase)
    {
        const std::size_t place = clip * posesPerClip + phase;
        if (_poses[place] == none)
            addPose(place, travel ? travel->sampleAt(travel->length() * static_cast<float>(phase) /
                                                     static_cast<float>(mostPhases))
                                  : BlendSample{});
        return _poses[place];
    }

    void addPose(std::size_t place, const BlendSample& sample)
    {
        if (_batches.empty() || _batches.back()->size() == _mostPoses)
            _batches.push_back(_frame.makeBatch(_instances.set()));
        _used.push_back(static_cast<std::uint32_t>(place));
        const std::size_t before = (_batches.size() - 1) * _mostPoses;
        _poses[place] = static_cast<std::uint32_t>(before + _batches.back()->addSample(sample));
    }

    const Meshes& _meshes;
    const CrowdInstances& _instances;
    const LodScale& _scale;
    PoseFrame& _frame;
    std::size_t _mostPoses;
    std::vector<std::unique_ptr<PoseBatch>> _batches;
    std::vector<std::uint32_t>& _poses;
    std::vector<std::uint32_t> _used; ///< the places in _poses that are not `none`
    DrawnByLevel& _drawn;
    std::array<std::optional<Band>, bandCount> _bands;
};

SharedPoses::Shape::Shape(SkinnedGeometry& mesh) : mesh(&mesh), vertices(mesh.getVertexArray()) {}

/// All meshes below the crowd, those of all levels of detail included.
std::vector<SharedPoses::Shape> SharedPoses::shapesBelow(const osg::Group& crowd)
{
    std::vector<Shape> shapes;
    for (unsigned int child = 0; child < crowd.getNumChildren(); ++child)
        forEachMeshBelow(*const_cast<osg::Node*>(crowd.getChild(child)),
                         [&](SkinnedGeometry& mesh) { shapes.emplace_back(mesh); });
    return shapes;
}

SharedPoses::SharedPoses(const osg::Group& crowd, const AnimationSet& set)
{
    const std::shared_ptr<Meshes> computed = std::make_shared<Meshes>();
    computed->shapes = shapesBelow(crowd);
    std::vector<const SkinnedGeometry*> skinned;
    for (const Shape& shape : computed->shapes)
        skinned.push_back(shape.mesh.get());
    MixBounds::Boxes boxes = mixBoxesOf(skinned, set);
    // Weights change colours and normals too: they count as if they moved the vertices through their box.
    const bool isMorphed = std::any_of(skinned.begin(), skinned.end(),
                                       [](const SkinnedGeometry* mesh) { return !mesh->getMorphTargets().empty(); });
    for (std::size_t entry = 0; isMorphed && entry < boxes.reaches.size(); ++entry)
        if (const Box& box = boxes.ofClips[entry]; !box.empty())
            boxes.reaches[entry] = std::max(boxes.reaches[entry], glm::distance(box.min, box.max));
    computed->travels = travelsOfClips(set, boxes.ofClips, boxes.reaches);
    for (const Clip& clip : set.clips())
        computed->durations.push_back(clip.duration());
    _meshes = computed;
}

bool SharedPoses::isOf(const osg::Group& crowd) const
{
    return shapesBelow(crowd) == _meshes->shapes;
}

void SharedPoses::forgetUnused()
{
    _before = std::move(_latest);
    _latest.clear();
}

/// The list itself, or an equal one that was drawn since the update before and is on the GPU.
std::shared_ptr<const PlacedInstances> SharedPoses::shared(std::shared_ptr<PlacedInstances> placed) const
{
    constexpr std::size_t mostKept = 16; // of a crowd without updates
    const auto isSame = [&](const std::shared_ptr<const PlacedInstances>& known)
    {
        return known->crowd == placed->crowd && known->placements == placed->placements &&
               known->tints == placed->tints && known->drawn.size() == placed->drawn.size() &&
               std::memcmp(known->drawn.data(), placed->drawn.data(),
                           placed->drawn.size() * sizeof(PlacedInstances::Drawn)) == 0;
    };
    const std::lock_guard<std::mutex> lock(_mutex);
    if (const auto known = std::find_if(_latest.begin(), _latest.end(), isSame); known != _latest.end()) return *known;
    const auto before = std::find_if(_before.begin(), _before.end(), isSame);
    if (_latest.size() == mostKept) _latest.erase(_latest.begin());
    return _latest.emplace_back(before != _before.end() ? *before : placed);
}

std::vector<DrawState> SharedPoses::submit(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                           std::vector<std::uint32_t>& seen) const
{
    const AnimationSet& set = *instances.set();
    const std::size_t placementTexels =
        (instances.size() + SharedBlocks<AffineMatrix>::blockSize) * POSE_TEXELS_PER_MATRIX;
    PosePipeline::Options options;
    options.maxTexels = frame.getMaxTexels();
    const std::size_t mostPoses = PosePipeline::chunkCapacity(set, options);
    std::vector<DrawState> draws;
    if (placementTexels > frame.getMaxTexels()) return draws;

    Collection collection(*_meshes, instances, scale, frame, mostPoses);
    const bool arePlain = instances.isWithoutControllers();
    std::size_t left = 0;
    for (const std::uint32_t index : seen)
        if ((!arePlain && instances.hasController(index)) || !collection.add(index)) seen[left++] = index;
    seen.resize(left);
    for (std::size_t number = 0; number < collection.batchCount(); ++number)
    {
        struct Run
        {
            int level;
            std::size_t first, count;
        };
        std::vector<Run> runs;
        std::unique_ptr<PoseBatch> batch = collection.takeBatch(number);
        const std::shared_ptr<PlacedInstances> list = std::make_shared<PlacedInstances>();
        list->crowd = instances.identity();
        list->placements = instances.placements();
        list->tints = instances.tints();
        list->poseCount = batch->size();
        collection.write(number, list->drawn,
                         [&](int level, std::size_t first, std::size_t count) {
                             runs.push_back({level, first, count});
                         });
        const std::shared_ptr<const PlacedInstances> placed = shared(list);
        const std::size_t slot = frame.submitShared(std::move(batch), &instances, placed);
        for (const Run& run : runs)
            draws.push_back(frame.placedState(set, slot, placed, run.first, run.count, run.level));
    }
    return draws;
}

} // namespace osgGpuAnimation
