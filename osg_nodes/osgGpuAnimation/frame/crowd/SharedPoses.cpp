// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/SharedPoses.h>

#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/math/detail/Builtins.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>

namespace osgGpuAnimation
{

namespace
{

/// The errors of a band have one level of detail, as without shared poses; the rest of the error is for poses. A band
/// is an eighth of the errors between two powers of two: its number is the upper bits of a float.
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
float minErrorOf(std::size_t band)
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
    Collection(const Meshes& meshes, const CrowdInstances& instances, const LodScale& scale)
        : _meshes(meshes), _scale(scale), _clock(instances.clock()), _storage(storageOfThread())
    {
        _storage.clear(meshes.clips.size());
    }

    /// Takes the members that share poses. outOthers: the indices of the rest.
    void take(const SeenMembers& seen, std::vector<std::uint32_t>& outOthers)
    {
        outOthers.clear();
        for (const SeenMembers::Span& span : seen.spans())
            for (const CrowdMember* begin = span.begin; begin != span.end;)
            {
                const std::ptrdiff_t count = std::min<std::ptrdiff_t>(span.end - begin, blockSize);
                const std::size_t sharing = chooseSharing(begin, begin + count, outOthers);
                findTravels(sharing);
                addSteps(sharing);
                begin += count;
            }
    }

    /// Numbers the steps that instances show and adds their poses to batches. function(): an empty batch. maxPoses: of
    /// a batch.
    template <typename Function>
    std::vector<std::unique_ptr<PoseBatch>> makeBatches(std::size_t maxPoses, Function function)
    {
        std::vector<std::unique_ptr<PoseBatch>> batches;
        std::uint32_t number = 0;
        for (std::size_t word = 0; word < _storage.shown.size(); ++word)
        {
            ShownSteps& shown = _storage.shown[word];
            shown.before = number;
            const BlendSample* poses = nullptr;
            for (std::uint64_t bits = shown.bits; bits != 0; bits &= bits - 1, ++number)
            {
                const unsigned int bit = countTrailingZeros(bits);
                const std::size_t place = 64 * word + bit;
                shown.ranks[bit] = static_cast<std::uint8_t>(number - shown.before);
                if (!poses) poses = _meshes.clips[_storage.clips[place / stepsOfClip]].poses.data();
                if (number % maxPoses == 0) batches.push_back(function());
                batches.back()->addPlain(poses[place % stepsOfClip]);
            }
        }
        return batches;
    }

    /// Writes the list of a batch, level by level, with the poses [first, first + count) of all batches.
    /// function(level, first, count): of a level in the list.
    template <typename Function>
    void write(std::size_t firstPose, std::size_t poseCount, std::vector<PlacedInstances::Drawn>& out,
               Function function) const
    {
        std::size_t max = 0;
        for (const auto& [level, shown] : _storage.shownOfLevel)
            max += shown.size();
        out.reserve(max);
        for (const auto& [level, shown] : _storage.shownOfLevel)
        {
            const std::size_t first = out.size();
            out.resize(first + shown.size());
            PlacedInstances::Drawn* end = out.data() + first;
            for (const PlacedInstances::Drawn& instance : shown)
            {
                const ShownSteps& steps = _storage.shown[instance.pose / 64];
                const std::size_t pose = steps.before + steps.ranks[instance.pose % 64] - firstPose;
                *end = {static_cast<std::uint32_t>(pose), instance.instance};
                end += pose < poseCount;
            }
            out.resize(static_cast<std::size_t>(end - out.data()));
            if (out.size() > first) function(level, first, out.size() - first);
        }
        out.shrink_to_fit(); // the list is kept; of several batches each has a part of the instances
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    static constexpr std::size_t stepsOfClip = (maxSteps / 64 + 1) * 64; ///< whole words of bits
    using Shown = std::vector<PlacedInstances::Drawn>;                   ///< poses are places: clips and their steps
    struct Band
    {
        Shown* shown;  ///< null: the band is new
        float ofLevel; ///< the error of the level of detail
    };
    /// Which of 64 steps are shown, and the numbers of their poses.
    struct ShownSteps
    {
        std::uint64_t bits = 0;
        std::uint32_t before = 0;             ///< the number of poses before them
        std::array<std::uint8_t, 64> ranks{}; ///< of each shown step among them
    };
    static constexpr std::ptrdiff_t blockSize = 128; ///< members
    /// A member that shares its pose.
    struct Chosen
    {
        const CrowdMember* member;
        const SharedClip* shared;
        Shown* shown;
        std::uint32_t firstPlace; ///< of the steps of its clip
        float reach;              ///< in steps, in [0, maxSteps]
    };
    /// Kept from cull to cull.
    struct Storage
    {
        std::array<Chosen, blockSize> chosen;
        std::array<float, blockSize> travels;   ///< of the chosen ones, in steps
        std::vector<std::uint32_t> firstOfClip; ///< the place of its first step; none: no instance plays it
        std::vector<std::uint32_t> clips;       ///< those that instances play, in the order of their places
        std::vector<ShownSteps> shown;          ///< by place / 64
        std::map<int, Shown> shownOfLevel;
        std::array<Band, bandCount> bands;

        void clear(std::size_t clipCount)
        {
            firstOfClip.assign(clipCount, none);
            clips.clear();
            shown.clear();
            for (auto& [level, drawn] : shownOfLevel)
                drawn.clear();
            bands.fill({nullptr, 0.0f});
        }
    };

    /// Not inline: loops would look up the thread's address again and again.
    OSGGPUANIMATION_NOINLINE static Storage& storageOfThread()
    {
        static thread_local Storage storage;
        return storage;
    }

    // Members pass several short loops in blocks: a processor overlaps the members of a short loop.

    /// Chooses the members that share poses. Returns their number.
    std::size_t chooseSharing(const CrowdMember* begin, const CrowdMember* end, std::vector<std::uint32_t>& outOthers)
    {
        std::array<float, blockSize> errors;
        for (const CrowdMember* member = begin; member != end; ++member)
            errors[member - begin] = _scale.allowedError(glm::vec3(member->sphere), member->sphere.w, member->scale);
        std::size_t sharing = 0, others = outOthers.size();
        outOthers.resize(others + static_cast<std::size_t>(end - begin));
        for (const CrowdMember* member = begin; member != end; ++member)
        {
            const float error = errors[member - begin];
            const Band& band = bandFor(error);
            const auto clip = static_cast<std::size_t>(member->clip - CrowdMember::controlled);
            const SharedClip& shared = _meshes.clips[clip];
            const float reach = (error - band.ofLevel) * shared.stepsPerTravel;
            const bool shares = reach >= shared.minReach;
            // Without a branch that no processor could predict.
            outOthers[others] = member->index;
            _storage.chosen[sharing] = {member, &shared, band.shown, firstOf(clip),
                                        std::min(std::max(reach, 0.0f), static_cast<float>(maxSteps))};
            others += !shares;
            sharing += shares;
        }
        outOthers.resize(others);
        return sharing;
    }

    /// Finds the travels of the chosen members, in steps.
    void findTravels(std::size_t count)
    {
        std::array<float, blockSize> times;
        for (std::size_t i = 0; i < count; ++i)
        {
            const Chosen& chosen = _storage.chosen[i];
            const double unrolled = chosen.member->offset + chosen.member->speed * _clock;
            times[i] = static_cast<float>(CrowdPlayback::loopTime(unrolled, chosen.shared->duration));
            chosen.shared->travel.prefetch(times[i]);
        }
        for (std::size_t i = 0; i < count; ++i)
        {
            const SharedClip& shared = *_storage.chosen[i].shared;
            _storage.travels[i] = shared.travel.at(times[i]) * shared.stepsPerTravel;
        }
    }

    /// Adds the chosen members with the steps that they show.
    void addSteps(std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i)
        {
            const Chosen& chosen = _storage.chosen[i];
            const float travel = _storage.travels[i];
            const int begin = static_cast<int>(travel - chosen.reach);
            const int first = std::max(begin + static_cast<int>(static_cast<float>(begin) < travel - chosen.reach), 0);
            const int last = std::min(static_cast<int>(travel + chosen.reach), maxSteps);
            const std::uint32_t step = roundest(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
            // From there on all steps reach the middle.
            const bool reachesMiddle = chosen.reach >= static_cast<float>(maxSteps / 2);
            const std::uint32_t place = chosen.firstPlace + (reachesMiddle ? maxSteps / 2 : step);
            _storage.shown[place / 64].bits |= std::uint64_t(1) << place % 64;
            chosen.shown->push_back({place, chosen.member->index});
        }
    }

    /// The number in [first, last] that ends in the most zeros in binary.
    static std::uint32_t roundest(std::uint32_t first, std::uint32_t last)
    {
        std::uint32_t mask = (first - 1) ^ last; // all bits from the highest one that differs; for 0 the result is 0
        for (const int shift : {1, 2, 4, 8})
            mask |= mask >> shift;
        return last & ~(mask >> 1);
    }

    const Band& bandFor(float error)
    {
        const std::size_t number = bandOf(error);
        Band& band = _storage.bands[number];
        if (!band.shown)
        {
            const int level = _scale.levelWithin(minErrorOf(number));
            band = {&_storage.shownOfLevel[level], static_cast<float>(_scale.foundError(level))};
        }
        return band;
    }

    /// The place of the first step of a clip.
    std::uint32_t firstOf(std::size_t clip)
    {
        std::uint32_t& first = _storage.firstOfClip[clip];
        if (first == none)
        {
            first = static_cast<std::uint32_t>(_storage.clips.size() * stepsOfClip);
            _storage.clips.push_back(static_cast<std::uint32_t>(clip));
            _storage.shown.resize(_storage.shown.size() + stepsOfClip / 64);
        }
        return first;
    }

    const Meshes& _meshes;
    const LodScale& _scale;
    double _clock; ///< seconds
    Storage& _storage;
};

/// All meshes below the crowd, those of all levels of detail included.
std::vector<SharedPoses::Shape> SharedPoses::shapesBelow(const osg::Group& crowd)
{
    std::vector<Shape> shapes;
    forEachMeshBelow(const_cast<osg::Group&>(crowd), [&](SkinnedGeometry& mesh) { shapes.emplace_back(mesh); });
    return shapes;
}

SharedPoses::SharedPoses(const osg::Group& crowd, const std::shared_ptr<const AnimationSet>& set)
{
    const std::shared_ptr<Meshes> computed = std::make_shared<Meshes>();
    computed->shapes = shapesBelow(crowd);
    std::vector<const SkinnedGeometry*> skinned;
    for (const Shape& shape : computed->shapes)
        skinned.push_back(shape.mesh.get());
    MixBounds::Boxes boxes = mixBoxesOf(skinned, *set);
    // Weights change colours and normals too: they count as if they moved the vertices through their box.
    const bool isMorphed = std::any_of(skinned.begin(), skinned.end(),
                                       [](const SkinnedGeometry* mesh) { return !mesh->getMorphTargets().empty(); });
    for (std::size_t entry = 0; isMorphed && entry < boxes.reaches.size(); ++entry)
        if (const Box& box = boxes.ofClips[entry]; !box.empty())
            boxes.reaches[entry] = std::max(boxes.reaches[entry], glm::distance(box.min, box.max));
    computed->thread = std::async(std::launch::async,
                                  [set, boxes = std::move(boxes), meshes = computed.get()]
                                  {
                                      meshes->addClips(*set, boxes);
                                      meshes->isMade = true;
                                  });
    _meshes = computed;
}

void SharedPoses::Meshes::addClips(const AnimationSet& set, const MixBounds::Boxes& boxes)
{
    clips.emplace_back().minReach = std::numeric_limits<float>::infinity();
    clips.emplace_back().poses.emplace_back();
    for (std::size_t clip = 0; clip < set.clips().size() && !isStopped; ++clip)
    {
        SharedClip& shared = clips.emplace_back();
        shared.travel = ClipTravel(set, clip, boxes.ofClips, boxes.reaches);
        shared.duration = set.clips()[clip].duration();
        const float length = shared.travel.length();
        const int steps = length > 0.0f ? maxSteps : 0;
        for (int step = 0; step <= steps; ++step)
            shared.poses.push_back(
                shared.travel.sampleAt(length * static_cast<float>(step) / static_cast<float>(maxSteps)));
        if (steps == 0) continue;
        shared.stepsPerTravel = static_cast<float>(steps) / length;
        shared.minReach = 0.5f;
    }
}

bool SharedPoses::isOf(const osg::Group& crowd) const
{
    return shapesBelow(crowd) == _meshes->shapes;
}

void SharedPoses::update(bool waits)
{
    if (waits) _meshes->thread.wait();
    _areUsed = _meshes->isMade;
    _before = std::move(_latest);
    _latest.clear();
}

/// The list itself, or an equal one that was drawn since the update before and is on the GPU.
std::shared_ptr<const PlacedInstances> SharedPoses::shared(std::shared_ptr<PlacedInstances> placed) const
{
    constexpr std::size_t maxKept = 16; // of a crowd without updates
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
    if (_latest.size() == maxKept) _latest.erase(_latest.begin());
    return _latest.emplace_back(before != _before.end() ? *before : placed);
}

std::vector<DrawState> SharedPoses::submit(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                           const DrawnLists* lists, const SeenMembers& seen,
                                           std::vector<std::uint32_t>& outOthers) const
{
    const AnimationSet& set = *instances.set();
    const std::size_t placementTexels =
        (instances.size() + SharedBlocks<AffineMatrix>::blockSize) * POSE_TEXELS_PER_MATRIX;
    PosePipeline::Options options;
    options.maxTexels = frame.getMaxTexels();
    const std::size_t maxPoses = PosePipeline::chunkCapacity(set, options);
    std::vector<DrawState> draws;
    if (placementTexels > frame.getMaxTexels())
    {
        seen.findIndices(instances.size(), outOthers);
        return draws;
    }
    Collection collection(*_meshes, instances, scale);
    collection.take(seen, outOthers);
    std::size_t firstPose = 0;
    for (std::unique_ptr<PoseBatch>& batch :
         collection.makeBatches(maxPoses, [&] { return frame.makeBatch(instances.set()); }))
    {
        std::vector<OutfitLists::Run> runs;
        const std::shared_ptr<PlacedInstances> list = std::make_shared<PlacedInstances>();
        list->crowd = instances.identity();
        list->placements = instances.placements();
        list->tints = instances.tints();
        list->poseCount = batch->size();
        collection.write(firstPose, batch->size(), list->drawn,
                         [&](int level, std::size_t first, std::size_t count) {
                             runs.push_back({level, first, count});
                         });
        firstPose += batch->size();
        if (lists) lists->arrange(instances, list->drawn, runs);
        submitPlaced(frame, instances, std::move(batch), shared(list), runs, draws);
    }
    return draws;
}

std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  const SharedPoses* shared, const DrawnLists* lists, const SeenMembers& seen)
{
    static thread_local std::vector<std::uint32_t> others; // keeps its storage from cull to cull
    std::vector<DrawState> draws;
    if (shared && shared->areUsed() && scale.isOn())
        draws = shared->submit(frame, instances, scale, lists, seen, others);
    else
        seen.findIndices(instances.size(), others);
    for (const DrawState& draw : submitSeen(frame, instances, scale, lists, others))
        draws.push_back(draw);
    return draws;
}

} // namespace osgGpuAnimation
