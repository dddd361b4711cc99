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

/// The errors of a band have one level of detail, as without shared poses; the rest of the error is for poses. A band
/// is an eighth of the errors between two powers of two: its number is the upper bits of a float.
constexpr float mostOfLevel = 1.0f; ///< the share of an error that a level of detail may have
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
///
/// An instance may show any step of its clip from a first to a last one; there is one if its error is at least half a
/// step. It shows the one that ends in the most zeros in binary. So large and small instances choose the same steps,
/// and each instance keeps its own step in all passes of a frame and as long as it may show it.
class SharedPoses::Collection
{
public:
    /// mostPoses: of a batch.
    Collection(const Meshes& meshes, const CrowdInstances& instances, const LodScale& scale, PoseFrame& frame,
               std::size_t mostPoses)
        : _meshes(meshes), _instances(instances), _scale(scale), _frame(frame), _mostPoses(mostPoses),
          _placeOfClip(meshes.clips.size() + 1, none), _poses(posesOfThread()), _drawn(drawnOfThread())
    {
        _poses.clear();
        for (auto& [level, drawn] : _drawn)
            drawn.clear();
    }

    std::size_t batchCount() const { return _batches.size(); }
    std::unique_ptr<PoseBatch> takeBatch(std::size_t batch) { return std::move(_batches[batch]); }

    /// Takes the instances without a controller out of the list, except those that need a pose of their own.
    void takeFrom(std::vector<std::uint32_t>& seen)
    {
        const bool arePlain = _instances.isWithoutControllers();
        std::size_t left = 0;
        for (const std::uint32_t index : seen)
            if ((!arePlain && _instances.hasController(index)) || !add(index)) seen[left++] = index;
        seen.resize(left);
    }

    /// Writes the list of a batch, level by level. function(level, first, count)
    template <typename Function>
    void write(std::size_t batch, std::vector<PlacedInstances::Drawn>& out, Function function) const
    {
        std::size_t count = 0;
        for (const auto& [level, drawn] : _drawn)
            count += drawn.size();
        out.reserve(count / _batches.size());
        const auto before = static_cast<std::uint32_t>(batch * _mostPoses); // poses of the batches before
        for (const auto& [level, drawn] : _drawn)
        {
            const std::size_t first = out.size();
            for (const auto& [number, instance] : drawn)
                if (const std::uint32_t pose = number - before; pose < _mostPoses) out.push_back({pose, instance});
            if (out.size() > first) function(level, first, out.size() - first);
        }
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    struct Band
    {
        std::vector<PlacedInstances::Drawn>* drawn; ///< poses are numbered through all batches
        float ofLevel;                              ///< the error of the level of detail
    };
    using DrawnByLevel = std::map<int, std::vector<PlacedInstances::Drawn>>;

    static std::vector<std::uint32_t>& posesOfThread()
    {
        static thread_local std::vector<std::uint32_t> poses;
        return poses;
    }
    static DrawnByLevel& drawnOfThread()
    {
        static thread_local DrawnByLevel drawn;
        return drawn;
    }

    /// False: the instance needs a pose of its own.
    bool add(std::uint32_t index)
    {
        const glm::vec4& sphere = _instances.sphere(index);
        const float error = _scale.allowedError(glm::vec3(sphere), sphere.w, _instances.scale(index));
        const Band& band = bandFor(error);
        const int clip = _instances.clip(index);
        std::uint32_t step = 0;
        if (clip >= 0 && _meshes.clips[static_cast<std::size_t>(clip)].stepsPerTravel > 0.0f)
        {
            const SharedClip& shared = _meshes.clips[static_cast<std::size_t>(clip)];
            const float reach = (error - band.ofLevel) * shared.stepsPerTravel;
            if (!(reach >= 0.5f)) return false;
            step = mostSteps / 2;
            if (reach < static_cast<float>(mostSteps / 2)) // else all steps reach the middle
            {
                const float time = static_cast<float>(_instances.time(index, shared.duration));
                const float at = shared.travel.at(time) * shared.stepsPerTravel;
                // Without branches on the phase, which no processor could predict.
                const int begin = static_cast<int>(at - reach);
                const int first = std::max(begin + static_cast<int>(static_cast<float>(begin) < at - reach), 0);
                const int last = std::min(static_cast<int>(at + reach), mostSteps);
                step = roundest(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
            }
        }
        const std::size_t place = placeOf(static_cast<std::size_t>(clip + 1)) + step;
        if (_poses[place] == none) _poses[place] = addPose(static_cast<std::size_t>(clip + 1), step);
        PlacedInstances::Drawn& drawn = band.drawn->emplace_back();
        drawn.pose = _poses[place];
        drawn.instance = index;
        return true;
    }

    /// The number in [first, last] that ends in the most zeros in binary.
    static std::uint32_t roundest(std::uint32_t first, std::uint32_t last)
    {
        if (first == 0) return 0;
        std::uint32_t mask = (first - 1) ^ last; // all bits from the highest one that differs
        for (const int shift : {1, 2, 4, 8})
            mask |= mask >> shift;
        return last & ~(mask >> 1);
    }

    const Band& bandFor(float error)
    {
        const std::size_t number = bandOf(error);
        std::optional<Band>& band = _bands[number];
        if (!band)
        {
            const int level = _scale.levelWithin(mostOfLevel * leastErrorOf(number));
            band = Band{&_drawn[level], static_cast<float>(_scale.foundError(level))};
        }
        return *band;
    }

    /// Of the first step of a clip in _poses. clip: its number + 1; 0: the rest pose.
    std::uint32_t placeOf(std::size_t clip)
    {
        if (_placeOfClip[clip] == none)
        {
            _placeOfClip[clip] = static_cast<std::uint32_t>(_poses.size());
            _poses.resize(_poses.size() + mostSteps + 1, none);
        }
        return _placeOfClip[clip];
    }

    std::uint32_t addPose(std::size_t clip, std::uint32_t step)
    {
        BlendSample sample;
        if (clip > 0)
        {
            const ClipTravel& travel = _meshes.clips[clip - 1].travel;
            sample = travel.sampleAt(travel.length() * static_cast<float>(step) / static_cast<float>(mostSteps));
        }
        if (_batches.empty() || _batches.back()->size() == _mostPoses)
            _batches.push_back(_frame.makeBatch(_instances.set()));
        const std::size_t before = (_batches.size() - 1) * _mostPoses;
        return static_cast<std::uint32_t>(before + _batches.back()->addSample(sample));
    }

    const Meshes& _meshes;
    const CrowdInstances& _instances;
    const LodScale& _scale;
    PoseFrame& _frame;
    std::size_t _mostPoses;
    std::vector<std::unique_ptr<PoseBatch>> _batches;
    std::vector<std::uint32_t> _placeOfClip; ///< by clip + 1; none: no instance plays it
    std::vector<std::uint32_t>& _poses;      ///< by place; none: no instance shows that step
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
    for (std::size_t clip = 0; clip < set.clips().size(); ++clip)
    {
        ClipTravel travel(set, clip, boxes.ofClips, boxes.reaches);
        const float stepsPerTravel = travel.length() > 0.0f ? static_cast<float>(mostSteps) / travel.length()
                                                            : std::numeric_limits<float>::infinity();
        computed->clips.push_back({std::move(travel), set.clips()[clip].duration(), stepsPerTravel});
    }
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
    collection.takeFrom(seen);
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
