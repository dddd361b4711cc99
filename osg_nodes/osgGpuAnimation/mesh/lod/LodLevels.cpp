// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/mesh/MeshSimplifier.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t poolSize = 64;

using Joints = std::vector<glm::vec3>;

Joints jointsOf(const AnimationSet& set, const PoseInstruction& instruction)
{
    std::vector<JointTransform> tracks;
    std::vector<AffineMatrix> jointToModel;
    Pose::mix(set, instruction, tracks);
    Pose::jointToModel(set, tracks, AffineMatrix(), jointToModel);
    Joints joints;
    glm::vec3 mean(0.0f);
    for (const AffineMatrix& joint : jointToModel)
    {
        joints.push_back(joint.transformPoint(glm::vec3(0.0f)));
        mean += joints.back() / static_cast<float>(jointToModel.size());
    }
    for (glm::vec3& joint : joints)
        joint -= mean;
    // Rotations and morphs that move no joint count a little.
    for (const JointTransform& track : tracks)
        joints.push_back(1e-3f * (glm::vec3(track.rotation) + glm::vec3(track.scale)));
    return joints;
}

float distanceOf(const Joints& a, const Joints& b)
{
    float distance = 0.0f;
    for (std::size_t joint = 0; joint < a.size(); ++joint)
        distance += glm::distance(a[joint], b[joint]);
    return distance;
}

// The finest level is the mesh's size divided by 2 to that power; the coarsest, which alone may cross texture seams, is
// the character's size divided so: coarser levels save little more and make small characters thin.
constexpr int finestFraction = 8;
constexpr int coarsestFraction = 5;
constexpr int maxBeyondSize = 10;             ///< powers of two above the mesh's size; it is one triangle there
constexpr double worthwhile = 0.85;           ///< a level has at most this share of the previous level's triangles
constexpr std::size_t measuredPerKeyPose = 4; ///< poses
constexpr int maxAttempts = 8;                ///< with more key poses each
constexpr std::size_t fewTriangles = 16;      ///< meshes with fewer get no levels
constexpr std::size_t entriesATriangle = 8;
constexpr double maxOutset = 0.25; ///< of a level's error
constexpr int levelsPerOctave = 2;

template <typename OsgArray, typename Vector>
void copyTo(const osg::Array* array, std::size_t count, std::vector<Vector>& out)
{
    const auto* values = dynamic_cast<const OsgArray*>(array);
    if (!values || values->size() != count) return;
    for (const auto& value : *values)
    {
        Vector copied;
        for (int i = 0; i < Vector::length(); ++i)
            copied[i] = std::isfinite(value[i]) ? value[i] : 0.0f;
        out.push_back(copied);
    }
}

/// Without poses if a position is not finite in one of them.
PosedSurface surfaceOf(const osg::Geometry& mesh, const AnimationSet& set, const LodLevels::Skinning& skin,
                       std::size_t poseCount, const std::atomic<bool>* stop)
{
    PosedSurface surface;
    surface.stop = stop;
    std::vector<AffineMatrix> palette;
    std::vector<glm::dvec3> positions;
    const MeasuredPoses measured(set, poseCount, measuredPerKeyPose * poseCount);
    surface.keyPoses = measured.keyPoseCount;
    for (const PoseInstruction& pose : measured.poses)
    {
        Pose::evaluate(set, pose, AffineMatrix(), palette);
        skin(palette, positions);
        surface.poses.emplace_back(positions.begin(), positions.end());
        const std::vector<glm::vec3>& posed = surface.poses.back();
        if (!posed.empty() && std::all_of(posed.begin(), posed.end(), isPlaced) && !surface.isStopped()) continue;
        surface.poses.clear();
        return surface;
    }
    const std::size_t count = positions.size();
    copyTo<osg::Vec3Array>(mesh.getNormalArray(), count, surface.normals);
    if (mesh.getNumTexCoordArrays() > 0) copyTo<osg::Vec2Array>(mesh.getTexCoordArray(0), count, surface.texCoords);
    return surface;
}

double sizeOf(const Box& box)
{
    return box.empty() ? 0.0 : glm::distance(glm::dvec3(box.min), glm::dvec3(box.max));
}

struct Extent
{
    double area = 0.0, volume = 0.0;
};

/// In the rest pose. The volume of an open surface is that of the cone from its first vertex.
Extent extentOf(const PosedSurface& surface, const std::vector<std::uint32_t>& indices)
{
    const std::vector<glm::vec3>& places = surface.poses.front();
    const auto edgeTo = [&](std::uint32_t vertex) { return glm::dvec3(places[vertex]) - glm::dvec3(places.front()); };
    Extent extent;
    for (std::size_t corner = 0; corner + 2 < indices.size(); corner += 3)
    {
        const glm::dvec3 a = edgeTo(indices[corner]), b = edgeTo(indices[corner + 1]), c = edgeTo(indices[corner + 2]);
        extent.area += glm::length(glm::cross(b - a, c - a)) / 2.0;
        extent.volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return extent;
}

/// True if posing the palette costs no more than reducing the triangles. Meshes of many small, separately animated
/// parts get no levels.
bool isWorthPoses(const osg::Geometry& mesh, const AnimationSet& set)
{
    std::size_t triangles = 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
        if (primitives) triangles = std::max<std::size_t>(triangles, primitives->getNumIndices() / 3);
    return triangles >= std::max(fewTriangles, set.paletteSize() / entriesATriangle);
}

template <typename Elements>
osg::ref_ptr<osg::DrawElements> makeElements(const std::vector<std::uint32_t>& indices)
{
    osg::ref_ptr<Elements> elements = new Elements(GL_TRIANGLES);
    elements->assign(indices.begin(), indices.end());
    return elements;
}

/// About so many times, spread over the clips; at most a quarter of them in one clip. count: at least 4.
std::vector<PoseInstruction> spreadPoses(const AnimationSet& set, std::size_t count)
{
    std::vector<PoseInstruction> pool;
    const std::size_t clips = set.clips().size();
    const std::size_t perClip = clips == 0 ? 0 : std::clamp<std::size_t>(count / clips, 1, count / 4);
    const std::size_t stride = std::max<std::size_t>(clips / count, 1);
    for (std::size_t clip = 0; clip < clips; clip += stride)
        for (std::size_t time = 0; time < perClip; ++time)
        {
            const double share = (static_cast<double>(time) + 0.5) / static_cast<double>(perClip);
            PoseInstruction instruction;
            instruction.samples[0] = set.sampleAt(static_cast<int>(clip), share * set.clips()[clip].duration());
            pool.push_back(instruction);
        }
    return pool;
}

} // namespace

std::vector<PoseInstruction> keyPoses(const AnimationSet& set, std::size_t count)
{
    std::vector<PoseInstruction> chosen{PoseInstruction()};
    const std::vector<PoseInstruction> pool = spreadPoses(set, poolSize);
    std::vector<Joints> joints;
    std::vector<float> distances;
    Joints last = jointsOf(set, chosen.front());
    for (const PoseInstruction& instruction : pool)
    {
        joints.push_back(jointsOf(set, instruction));
        distances.push_back(distanceOf(joints.back(), last));
    }
    while (chosen.size() < count && !pool.empty())
    {
        const auto next = std::max_element(distances.begin(), distances.end());
        if (!(*next > 0.0f)) break;
        const auto index = static_cast<std::size_t>(next - distances.begin());
        chosen.push_back(pool[index]);
        for (std::size_t other = 0; other < pool.size(); ++other)
            distances[other] = std::min(distances[other], distanceOf(joints[other], joints[index]));
    }
    return chosen;
}

MeasuredPoses::MeasuredPoses(const AnimationSet& set, std::size_t maxKeyPoses, std::size_t otherPoseCount)
    : poses(keyPoses(set, maxKeyPoses)), keyPoseCount(poses.size())
{
    const std::vector<PoseInstruction> others = spreadPoses(set, otherPoseCount);
    poses.insert(poses.end(), others.begin(), others.end());
}

float maxScale(const AffineMatrix& matrix)
{
    float max = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float x = matrix.rows[0][axis], y = matrix.rows[1][axis], z = matrix.rows[2][axis];
        max = std::max(max, x * x + y * y + z * z);
    }
    return std::sqrt(max);
}

std::vector<std::uint32_t> LodLevels::trianglesOf(const osg::PrimitiveSet* primitives, std::size_t vertexCount)
{
    std::vector<std::uint32_t> indices;
    const osg::DrawElements* elements = primitives ? primitives->getDrawElements() : nullptr;
    if (!elements || elements->getMode() != GL_TRIANGLES || !elements->getDataPointer()) return indices;
    for (unsigned int i = 0; i + 2 < elements->getNumIndices(); i += 3)
        for (unsigned int corner = i; corner < i + 3; ++corner)
        {
            if (elements->index(corner) >= vertexCount) return {};
            indices.push_back(elements->index(corner));
        }
    return indices;
}

std::size_t LodLevels::poseCountOf(std::size_t vertices, std::size_t posedVertices)
{
    return std::clamp(posedVertices / std::max<std::size_t>(vertices, 1), minPoses, maxPoses);
}

int LodLevels::levelOf(double error)
{
    if (!(error > 0.0 && std::isfinite(error))) return allTriangles;
    const int level = static_cast<int>(std::floor(levelsPerOctave * std::log2(error / (1.0 + maxOutset))));
    return errorOf(level + 1) <= error ? level + 1 : level; // rounding
}

int LodLevels::levelFor(double error)
{
    const int level = levelOf(error);
    return level != allTriangles && errorOf(level) < error ? level + 1 : level;
}

double LodLevels::errorOf(int level)
{
    return level == allTriangles ? 0.0 : (1.0 + maxOutset) * std::exp2(static_cast<double>(level) / levelsPerOctave);
}

LodLevels::LodLevels(const osg::Geometry& mesh)
    : _vertices(mesh.getVertexArray()), _modifiedCount(_vertices ? _vertices->getModifiedCount() : 0)
{
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
        _primitives.push_back({primitives, primitives ? primitives->getModifiedCount() : 0, {}});
}

void LodLevels::addSteps(const osg::Geometry& copy, const AnimationSet& set, const Skinning& skin,
                         const std::atomic<bool>* stop)
{
    const std::size_t vertexCount = copy.getVertexArray() ? copy.getVertexArray()->getNumElements() : 0;
    if (vertexCount > maxVertices || !isWorthPoses(copy, set)) return;
    PosedSurface surface = surfaceOf(copy, set, skin, poseCountOf(vertexCount), stop);
    if (surface.poses.empty()) return;
    const double size = surface.size();
    if (!(size > 0.0)) return;
    const int finest = levelsPerOctave * (std::ilogb(size) - finestFraction);
    const int coarsest =
        levelsPerOctave * std::min(std::ilogb(std::max(size, sizeOf(boundsOfJoints(set)))) - coarsestFraction,
                                   std::ilogb(size) + maxBeyondSize);
    for (int attempt = 0; attempt < maxAttempts; ++attempt)
    {
        std::set<std::size_t> beyond;
        for (unsigned int i = 0; i < _primitives.size(); ++i)
            _primitives[i].steps = makeSteps(surface, finest, coarsest, copy.getPrimitiveSet(i), beyond);
        if (beyond.empty() || surface.isStopped()) break;
        for (const std::size_t pose : beyond)
            std::swap(surface.poses[surface.keyPoses++], surface.poses[pose]);
    }
    for (const Primitives& primitives : _primitives)
        includeRange(primitives.steps);
}

/// outBeyond: receives poses in which the error of a level is too large: they should be key poses.
LodLevels::Steps LodLevels::makeSteps(const PosedSurface& surface, int finest, int coarsest,
                                      const osg::PrimitiveSet* primitives, std::set<std::size_t>& outBeyond) const
{
    Steps steps;
    const std::vector<std::uint32_t> original = trianglesOf(primitives, surface.vertexCount());
    if (original.size() < 3 * fewTriangles) return steps;
    MeshSimplifier simplifier(surface, original);
    const Extent whole = extentOf(surface, original);
    std::size_t kept = original.size() / 3;
    for (int level = finest; level <= coarsest; level += levelsPerOctave)
    {
        if (simplifier.triangleCount() <= 1 || surface.isStopped()) break;
        const double limit = errorOf(level) / (1.0 + maxOutset);
        simplifier.reduce(limit, level < coarsest);
        if (static_cast<double>(simplifier.triangleCount()) >= worthwhile * static_cast<double>(kept)) continue;
        const std::vector<std::uint32_t> indices = simplifier.indices();
        const Extent extent = extentOf(surface, indices);
        const double lost = extent.area > 0.0 ? (whole.volume - extent.volume) / extent.area : 0.0;
        const double outset = std::clamp(lost, 0.0, maxOutset * limit);
        std::size_t worst = 0;
        const double error = simplifier.error(&worst) + outset;
        if (error > errorOf(level) && worst >= surface.keyPoses) outBeyond.insert(worst);
        const int first = std::max(level, levelFor(error));
        if (first > coarsest) continue;
        osg::ref_ptr<osg::DrawElements> elements = surface.vertexCount() <= 65535
                                                       ? makeElements<osg::DrawElementsUShort>(indices)
                                                       : makeElements<osg::DrawElementsUInt>(indices);
        elements->setElementBufferObject(_buffer);
        while (!steps.empty() && steps.back().level >= first)
            steps.pop_back();
        steps.push_back({first, elements, static_cast<float>(outset), error});
        kept = indices.size() / 3;
    }
    return steps;
}

void LodLevels::shareSteps(const LodLevels& other)
{
    for (std::size_t i = 0; i < _primitives.size(); ++i)
        _primitives[i].steps = other._primitives[i].steps;
    _buffer = other._buffer;
    _finest = other._finest;
    _coarsest = other._coarsest;
}

void LodLevels::includeRange(const Steps& steps)
{
    if (steps.empty()) return;
    const int first = steps.front().level;
    _finest = _finest == allTriangles ? first : std::min(_finest, first);
    _coarsest = std::max(_coarsest, steps.back().level);
}

bool LodLevels::mayFollow(int previous, int level, double error)
{
    // Cull computes with floats.
    return level > previous && std::isnormal(static_cast<float>(errorOf(level))) && error >= 0.0 &&
           std::isfinite(static_cast<float>(error));
}

Result<std::shared_ptr<const LodLevels>> LodLevels::restored(const osg::Geometry& mesh, std::vector<Steps> steps)
{
    if (steps.size() != mesh.getNumPrimitiveSets())
        return Error{std::to_string(steps.size()) + " lists of levels for " +
                     std::to_string(mesh.getNumPrimitiveSets()) + " primitive sets"};
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
        if (!primitives) return Error{"a missing primitive set"};
    const std::shared_ptr<LodLevels> levels(new LodLevels(mesh));
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (const Result<void> taken = levels->restore(i, std::move(steps[i])); !taken) return taken.error();
    return std::shared_ptr<const LodLevels>(levels);
}

Result<void> LodLevels::restore(std::size_t primitiveSet, Steps steps)
{
    const std::size_t vertexCount = _vertices ? _vertices->getNumElements() : 0;
    int previous = allTriangles;
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
        const Step& step = steps[i];
        const std::string subject = "primitive set " + std::to_string(primitiveSet) + ", step " + std::to_string(i);
        if (!mayFollow(previous, step.level, step.error) || !(step.outset >= 0.0f && std::isfinite(step.outset)))
            return Error{subject + ": level " + std::to_string(step.level) + " with an error of " +
                         std::to_string(step.error) + " and an outset of " + std::to_string(step.outset)};
        const std::size_t count = step.elements->getNumIndices();
        if (count == 0 || trianglesOf(step.elements, vertexCount).size() != count)
            return Error{subject + ": " + std::to_string(count) + " indices that are not whole triangles of " +
                         std::to_string(vertexCount) + " vertices"};
        step.elements->setElementBufferObject(_buffer);
        previous = step.level;
    }
    includeRange(steps);
    _primitives[primitiveSet].steps = std::move(steps);
    return {};
}

bool LodLevels::isOf(const osg::Geometry& mesh) const
{
    if (mesh.getVertexArray() != _vertices || mesh.getNumPrimitiveSets() != _primitives.size()) return false;
    if (_vertices && _vertices->getModifiedCount() != _modifiedCount) return false;
    for (unsigned int i = 0; i < _primitives.size(); ++i)
    {
        const osg::PrimitiveSet* now = mesh.getPrimitiveSet(i);
        if (now != _primitives[i].original || (now && now->getModifiedCount() != _primitives[i].modifiedCount))
            return false;
    }
    return true;
}

const LodLevels::Step& LodLevels::reduced(std::size_t primitiveSet, int level) const
{
    static const Step whole;
    const Step* found = &whole;
    if (primitiveSet >= _primitives.size()) return whole;
    for (const Step& step : steps(primitiveSet))
        if (step.level <= level) found = &step;
    return *found;
}

double LodLevels::foundError(int level) const
{
    double error = 0.0;
    for (std::size_t i = 0; i < _primitives.size(); ++i)
        error = std::max(error, reduced(i, level).error);
    return error;
}

std::shared_ptr<const LodLevels> MeshLod::known(const osg::Geometry& mesh) const
{
    std::shared_ptr<const LodLevels> levels = std::atomic_load(&_levels);
    return levels && levels->isOf(mesh) ? levels : nullptr;
}

void MeshLod::forget()
{
    ++_forgetCount;
    set(nullptr);
}

} // namespace osgGpuAnimation
