// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Rotation.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/callbacks/CharacterStates.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

constexpr double fadeSeconds = 0.25; ///< from the springs to the clips and back
constexpr double maxSubsteps = SpringBones::longestStep / SpringBones::substep + 1.0;
constexpr double gridTolerance = 1e-6; ///< of a substep: sums of frame times miss the substep's time by rounding

glm::dvec3 toDouble(const osg::Vec3& vector)
{
    return {vector.x(), vector.y(), vector.z()};
}

glm::dmat4 toColumns(const osg::Matrixd& matrix)
{
    return glm::make_mat4(matrix.ptr());
}

/// A pair of joints of a chain: the head turns, the tail swings.
struct Bone
{
    std::size_t head;
    const SpringJoint* settings;
    const std::vector<std::size_t>* colliders;
    glm::dvec3 tail; ///< the tail's place at rest, in the head's space
};

/// The chains of one set, by joint.
struct Springs
{
    std::vector<Bone> bones;                    ///< ancestors first
    std::vector<std::size_t> moved;             ///< heads and all joints below them, ancestors first
    std::vector<std::size_t> jointsOfColliders; ///< by collider
};

std::string nameOf(std::size_t collider)
{
    return "springs: collider " + std::to_string(collider) + ": ";
}

std::string nameOf(std::size_t chain, const std::string& joint)
{
    return "springs: chain " + std::to_string(chain) + ", joint \"" + joint + "\": ";
}

bool isLength(float value)
{
    return std::isfinite(value) && value >= 0.0f;
}

bool isFinite(const osg::Vec3& vector)
{
    return std::isfinite(vector.x()) && std::isfinite(vector.y()) && std::isfinite(vector.z());
}

std::optional<std::string> faultOf(const SpringJoint& joint)
{
    const auto fault = [](const std::string& subject, float value, const char* expected)
    { return subject + std::to_string(value) + ", not " + expected; };
    if (!isLength(joint.stiffness)) return fault("its stiffness is ", joint.stiffness, "in [0, infinity)");
    if (!(joint.drag >= 0.0f && joint.drag <= 1.0f)) return fault("its drag is ", joint.drag, "in [0, 1]");
    if (!std::isfinite(joint.gravity)) return fault("its gravity is ", joint.gravity, "finite");
    const float length = joint.gravityDirection.length();
    if (!(std::abs(length - 1.0f) < 1e-3f)) return fault("its gravity's direction has length ", length, "1");
    if (!isLength(joint.radius)) return fault("its radius is ", joint.radius, "in [0, infinity)");
    return std::nullopt;
}

/// The place of the joint `below` at rest in the space of `head`; none if it is no descendant.
std::optional<glm::dvec3> placeAtRest(const Skeleton& skeleton, int head, int below)
{
    glm::dmat4 place(1.0);
    for (int joint = below; joint != head; joint = skeleton.joint(static_cast<std::size_t>(joint)).parent)
    {
        if (joint < 0) return std::nullopt;
        place = skeleton.joint(static_cast<std::size_t>(joint)).rest.toMatrix().toColumns() * place;
    }
    return glm::dvec3(place[3]);
}

/// The first fault of the settings that needs no set; none if they are good.
std::optional<Error> faultOf(const std::vector<SpringChain>& chains, const std::vector<SpringCollider>& colliders)
{
    for (std::size_t i = 0; i < colliders.size(); ++i)
        if (!isLength(colliders[i].radius) || !isFinite(colliders[i].center) ||
            !isFinite(colliders[i].tail.value_or(osg::Vec3())))
            return Error{nameOf(i) + "its radius is not in [0, infinity), or its place is not finite"};
    for (std::size_t i = 0; i < chains.size(); ++i)
    {
        const std::string name = "springs: chain " + std::to_string(i);
        if (chains[i].joints.size() < 2)
            return Error{name + " has " + std::to_string(chains[i].joints.size()) + " joints, not at least 2"};
        for (const std::size_t collider : chains[i].colliders)
            if (collider >= colliders.size()) return Error{name + ": there is no collider " + std::to_string(collider)};
        for (const SpringJoint& joint : chains[i].joints)
            if (const std::optional<std::string> fault = faultOf(joint)) return Error{nameOf(i, joint.joint) + *fault};
    }
    return std::nullopt;
}

Result<Springs> resolve(const AnimationSet& set, const std::vector<SpringChain>& chains,
                        const std::vector<SpringCollider>& colliders)
{
    if (const std::optional<Error> fault = faultOf(chains, colliders)) return *fault;
    const Skeleton& skeleton = set.skeleton();
    Springs springs;
    for (std::size_t i = 0; i < colliders.size(); ++i)
    {
        const Result<std::size_t> joint = skeleton.jointNamed(colliders[i].joint);
        if (!joint) return Error{nameOf(i) + joint.error().message};
        springs.jointsOfColliders.push_back(joint.value());
    }
    std::vector<bool> isMoved(skeleton.jointCount()), isUsed(skeleton.jointCount());
    for (std::size_t i = 0; i < chains.size(); ++i)
    {
        std::optional<std::size_t> previous;
        for (const SpringJoint& settings : chains[i].joints)
        {
            const std::string name = nameOf(i, settings.joint);
            const Result<std::size_t> joint = skeleton.jointNamed(settings.joint);
            if (!joint) return Error{name + joint.error().message};
            if (isUsed[joint.value()]) return Error{name + "it is in two chains or twice in one"};
            isUsed[joint.value()] = true;
            if (previous)
            {
                const std::optional<glm::dvec3> tail =
                    placeAtRest(skeleton, static_cast<int>(*previous), static_cast<int>(joint.value()));
                if (!tail) return Error{name + "it is no descendant of the joint before it"};
                if (!(glm::length(*tail) > 0.0)) return Error{name + "it has the place of the joint before it"};
                springs.bones.push_back({*previous, &settings - 1, &chains[i].colliders, *tail});
                isMoved[*previous] = true;
            }
            previous = joint.value();
        }
    }
    const auto isAbove = [](const Bone& a, const Bone& b) { return a.head < b.head; }; // joints are in level order
    std::sort(springs.bones.begin(), springs.bones.end(), isAbove);
    for (std::size_t joint = 0; joint < skeleton.jointCount(); ++joint)
    {
        const int parent = skeleton.joint(joint).parent;
        if (parent >= 0 && isMoved[static_cast<std::size_t>(parent)]) isMoved[joint] = true;
        if (isMoved[joint]) springs.moved.push_back(joint);
    }
    return springs;
}

glm::dmat4 toMatrix(const JointTransform& transform, const glm::dquat& rotation)
{
    glm::dmat4 matrix = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis)
        matrix[axis] *= static_cast<double>(transform.scale[axis]);
    matrix[3] = glm::dvec4(glm::dvec3(transform.translation), 1.0);
    return matrix;
}

/// From a to b by the share: translation and scale linearly, rotation by slerp.
osg::Matrixd between(const osg::Matrixd& a, const osg::Matrixd& b, double share)
{
    if (a == b) return b;
    const osg::Matrixd turnA = rotationOf(a), turnB = rotationOf(b);
    const osg::Matrixd restA = a * osg::Matrixd::inverse(turnA), restB = b * osg::Matrixd::inverse(turnB);
    osg::Matrixd mixed;
    for (int i = 0; i < 12; ++i)
        mixed.ptr()[i] = (1.0 - share) * restA.ptr()[i] + share * restB.ptr()[i];
    osg::Quat turn;
    turn.slerp(share, turnA.getRotate(), turnB.getRotate());
    mixed = mixed * osg::Matrixd::rotate(turn);
    mixed.setTrans(a.getTrans() * (1.0 - share) + b.getTrans() * share);
    return mixed;
}

/// Pushes the place out of the collider; false if it is outside.
bool pushOut(const SpringCollider& collider, const glm::dmat4& jointToWorld, double scale, double radius,
             glm::dvec3& place)
{
    const glm::dvec3 center(jointToWorld * glm::dvec4(toDouble(collider.center), 1.0));
    glm::dvec3 away = place - center;
    if (collider.tail)
    {
        const glm::dvec3 along = glm::dvec3(jointToWorld * glm::dvec4(toDouble(*collider.tail), 1.0)) - center;
        const double squared = glm::dot(along, along), projected = glm::dot(along, away);
        if (squared > 0.0) away -= along * std::clamp(projected / squared, 0.0, 1.0);
    }
    const double distance = glm::length(away), min = scale * (static_cast<double>(collider.radius) + radius);
    if (!(distance < min) || distance == 0.0) return false;
    place += away * (min / distance - 1.0);
    return true;
}

/// The chains of one character.
class State
{
public:
    /// The chains in the set; null, with one warning, if they do not fit it.
    const Springs* springs(const std::shared_ptr<const AnimationSet>& set, const std::vector<SpringChain>& chains,
                           const std::vector<SpringCollider>& colliders)
    {
        if (_set != set)
        {
            Result<Springs> resolved = resolve(*set, chains, colliders);
            if (!resolved) OSG_WARN << resolved.error().message << std::endl;
            _springs = resolved ? std::optional<Springs>(std::move(resolved.value())) : std::nullopt;
            _set = set;
        }
        return _springs ? &*_springs : nullptr;
    }

    void reset() { _before.reset(); }

    void update(const Springs& springs, const std::vector<SpringCollider>& colliders, AnimatedCharacter& character,
                const osg::Matrixd& nodeToWorld, const osg::FrameStamp& stamp, std::size_t layer)
    {
        const double time = stamp.getSimulationTime();
        const unsigned int frame = stamp.getFrameNumber();
        AnimationController& controller = character.getController();
        const osg::Matrixd fileToWorld = character.getFileToNode() * nodeToWorld;
        // A character with several places has one pose: that of the first.
        if (!fileToWorld.valid() || _frame == frame) return;
        _frame = frame;
        const double start = _time, length = time - start;
        const bool continues = _before && _before->sharedSet() == controller.sharedSet() && length >= 0.0 &&
                               length <= SpringBones::longestStep;
        const osg::Matrixd from = _fileToWorld;
        _time = time;
        _fileToWorld = fileToWorld;
        if (!continues) _before.reset();
        if (_before)
        {
            const double first = std::floor(start / SpringBones::substep + gridTolerance) + 1.0;
            const double last = std::floor(time / SpringBones::substep + gridTolerance);
            const int count = static_cast<int>(std::clamp(last - first + 1.0, 0.0, maxSubsteps));
            double now = start;
            for (int i = 0; i < count; ++i)
            {
                const double at = std::clamp((first + i) * SpringBones::substep, now, time);
                takePose(_before->advance(at - now), between(from, fileToWorld, (at - start) / length));
                swing(springs, colliders, 1.0);
                now = at;
            }
            _before->advance(time - now);
            if (hasJumped(controller)) _before.reset();
        }
        takePose(controller.instruction(), fileToWorld);
        if (!_before) rest(springs);
        const double since = time / SpringBones::substep - std::floor(time / SpringBones::substep + gridTolerance);
        show(springs, colliders, std::max(since, 0.0), controller.layer(layer));
        _before = std::make_unique<AnimationController>(controller);
    }

    void stop(AnimatedCharacter& character, std::size_t layer)
    {
        if (!_before) return;
        _before.reset();
        _isFaded = character.getController().layer(layer).fadeWeight(0.0f, fadeSeconds);
    }

private:
    /// True if the time of a clip is not the one to which the controller would have played it.
    bool hasJumped(const AnimationController& controller) const
    {
        const std::size_t count = std::min(controller.layerCount(), _before->layerCount());
        for (std::size_t i = 0; i < count; ++i)
        {
            const ClipPlayback& before = std::as_const(*_before).layer(i).playback();
            const ClipPlayback& now = controller.layer(i).playback();
            if (before.clip() != now.clip()) continue;
            double apart = std::abs(before.time() - now.time());
            // Rounding may put one of them before the end of the loop and the other after it.
            if (controller.layer(i).settings().loopMode == LoopMode::Loop)
                apart = std::min(apart, std::abs(now.duration() - apart));
            if (apart > SpringBones::seekSeconds) return true;
        }
        return false;
    }

    void takePose(const PoseInstruction& instruction, const osg::Matrixd& fileToWorld)
    {
        const AnimationSet& set = *_set;
        Pose::mix(set, instruction, _tracks);
        Pose::jointToModel(set, _tracks, AffineMatrix(), _jointToModel);
        _rootToWorld = toColumns(fileToWorld);
        _scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(_rootToWorld))));
    }

    glm::dmat4 parentToWorld(const Skeleton& skeleton, std::size_t joint) const
    {
        const int parent = skeleton.joint(joint).parent;
        return parent < 0 ? _rootToWorld : _jointToWorld[static_cast<std::size_t>(parent)];
    }

    /// Sets the matrices of all joints to the world. turn(bone, its index, parentToWorld): the rotation of the bone's
    /// head.
    template <typename Turn>
    void place(const Springs& springs, Turn turn)
    {
        const Skeleton& skeleton = _set->skeleton();
        // Colliders below a chain have the place of the step before until the chain reaches them.
        const bool isNew = _jointToWorld.size() != skeleton.jointCount();
        _jointToWorld.resize(skeleton.jointCount());
        auto moved = springs.moved.begin();
        for (std::size_t joint = 0; joint < skeleton.jointCount(); ++joint)
        {
            const bool isMoved = moved != springs.moved.end() && *moved == joint;
            if (isMoved) ++moved;
            if (!isMoved || isNew) _jointToWorld[joint] = _rootToWorld * _jointToModel[joint].toColumns();
        }
        auto bone = springs.bones.begin();
        for (const std::size_t joint : springs.moved)
        {
            const JointTransform& local = _tracks[joint];
            const glm::dmat4 above = parentToWorld(skeleton, joint);
            glm::dquat rotation = Rotation::quaternion(local.rotation);
            if (bone != springs.bones.end() && bone->head == joint)
            {
                rotation = turn(*bone, static_cast<std::size_t>(bone - springs.bones.begin()), above);
                ++bone;
            }
            _jointToWorld[joint] = above * toMatrix(local, rotation);
        }
    }

    void rest(const Springs& springs)
    {
        _rotations.resize(springs.bones.size());
        _tails.resize(springs.bones.size());
        _jointToWorld.clear();
        place(springs,
              [&](const Bone& bone, std::size_t index, const glm::dmat4& above)
              {
                  _rotations[index] = restRotation(bone);
                  const glm::dmat4 atRest = above * toMatrix(_tracks[bone.head], _rotations[index]);
                  _tails[index].now = _tails[index].before = glm::dvec3(atRest * glm::dvec4(bone.tail, 1.0));
                  return _rotations[index];
              });
    }

    glm::dquat restRotation(const Bone& bone) const
    {
        return Rotation::quaternion(_set->skeleton().joint(bone.head).rest.rotation);
    }

    /// Moves all tails by a share of a substep (VRMC_springBone 1.0, "Update procedure").
    void swing(const Springs& springs, const std::vector<SpringCollider>& colliders, double share)
    {
        const double seconds = share * SpringBones::substep;
        place(springs,
              [&](const Bone& bone, std::size_t index, const glm::dmat4& above)
              {
                  const SpringJoint& settings = *bone.settings;
                  const glm::dquat atRest = restRotation(bone);
                  const JointTransform& local = _tracks[bone.head];
                  const glm::dmat4 restToWorld = above * toMatrix(local, atRest);
                  const glm::dvec3 head(restToWorld[3]);
                  const glm::dvec3 restTail = glm::dvec3(restToWorld * glm::dvec4(bone.tail, 1.0)) - head;
                  const double length = glm::length(restTail);
                  Tail& tail = _tails[index];
                  if (!(length > 0.0)) return _rotations[index] = atRest; // an animated scale of 0
                  const auto keepLength = [&](const glm::dvec3& place)
                  {
                      const glm::dvec3 way = place - head;
                      const double distance = glm::length(way);
                      return head + (distance > 0.0 ? way * (length / distance) : restTail);
                  };
                  glm::dvec3 next = keepLength(
                      tail.now + (tail.now - tail.before) * (share * (1.0 - static_cast<double>(settings.drag))) +
                      restTail * (seconds * _scale * static_cast<double>(settings.stiffness) / length) +
                      toDouble(settings.gravityDirection) * (seconds * _scale * static_cast<double>(settings.gravity)));
                  for (const std::size_t number : *bone.colliders)
                      if (pushOut(colliders[number], _jointToWorld[springs.jointsOfColliders[number]], _scale,
                                  static_cast<double>(settings.radius), next))
                          next = keepLength(next);
                  tail.before = tail.now;
                  tail.now = next;
                  const glm::dvec3 scaled = bone.tail * glm::dvec3(local.scale);
                  const glm::dvec3 wanted = glm::inverse(glm::dmat3(above)) * (next - head);
                  const glm::dquat shortest(glm::normalize(atRest * scaled), glm::normalize(wanted));
                  const glm::dquat rotation = shortest * atRest;
                  return _rotations[index] = std::isfinite(glm::dot(rotation, rotation)) ? rotation : atRest;
              });
    }

    /// Writes the rotations at the present time, which is a share of a substep after the last one.
    void show(const Springs& springs, const std::vector<SpringCollider>& colliders, double share, AnimationLayer& layer)
    {
        const std::vector<Tail> tails = _tails;
        const std::vector<glm::dquat> rotations = _rotations;
        if (share > gridTolerance) swing(springs, colliders, share);
        JointPose& pose = layer.pose();
        if (!_before) pose.reset(); // also rotations of earlier chains
        for (std::size_t i = 0; i < springs.bones.size(); ++i)
            pose.setRotation(springs.bones[i].head, glm::quat(_rotations[i]));
        if (_isFaded) layer.fadeWeight(1.0f, fadeSeconds);
        _isFaded = false;
        _tails = tails;
        _rotations = rotations;
    }

    struct Tail
    {
        glm::dvec3 now, before; ///< in world space, at the last substep and at the one before it
    };

    std::shared_ptr<const AnimationSet> _set; ///< of _springs
    std::optional<Springs> _springs;
    std::unique_ptr<AnimationController> _before; ///< the controller at _time; null: the chains start at rest
    double _time = 0.0;                           ///< seconds, of the last update
    std::optional<unsigned int> _frame;           ///< of the last update
    osg::Matrixd _fileToWorld;                    ///< at _time
    std::vector<Tail> _tails;                     ///< by bone
    std::vector<glm::dquat> _rotations;           ///< by bone: of its head
    bool _isFaded = true; ///< the layer fades in again; a copied or stored character may have been stopped
    // Of the present substep:
    std::vector<JointTransform> _tracks;
    std::vector<AffineMatrix> _jointToModel;
    std::vector<glm::dmat4> _jointToWorld;
    glm::dmat4 _rootToWorld{1.0};
    double _scale = 1.0;
};

} // namespace

/// One state per character.
class SpringBones::States : public CharacterStates<State>
{
};

SpringBones::SpringBones() : _layer(maxLayers - 1), _states(std::make_unique<States>()) {}

SpringBones::SpringBones(const SpringBones& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop),
      _chains(other._chains), _colliders(other._colliders), _layer(other._layer), _maxDistance(other._maxDistance),
      _states(std::make_unique<States>())
{
}

SpringBones::~SpringBones() = default;

Result<void> SpringBones::setChains(const AnimationSet& set, std::vector<SpringChain> chains,
                                    std::vector<SpringCollider> colliders)
{
    const Result<Springs> resolved = resolve(set, chains, colliders);
    if (!resolved) return resolved.error();
    return setChains(std::move(chains), std::move(colliders));
}

Result<void> SpringBones::setChains(std::vector<SpringChain> chains, std::vector<SpringCollider> colliders)
{
    if (const std::optional<Error> fault = faultOf(chains, colliders)) return *fault;
    _chains = std::move(chains);
    _colliders = std::move(colliders);
    _states->clear();
    return {};
}

void SpringBones::setLayer(std::size_t layer)
{
    _layer = std::min(layer, maxLayers - 1);
}

void SpringBones::reset()
{
    _states->forEach([](AnimatedCharacter&, State& state) { state.reset(); });
}

void SpringBones::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    auto* character = dynamic_cast<AnimatedCharacter*>(node);
    const osg::FrameStamp* stamp = visitor->getFrameStamp();
    if (character && stamp)
    {
        if (osgUtil::CullVisitor* cull = visitor->asCullVisitor())
            _states->see(*character, *cull);
        else if (visitor->getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR)
        {
            State& state = _states->of(*character);
            const Springs* springs = state.springs(character->getController().sharedSet(), _chains, _colliders);
            if (springs && _states->isWithin(*character, _maxDistance, stamp->getFrameNumber()))
                state.update(*springs, _colliders, *character, osg::computeLocalToWorld(visitor->getNodePath()), *stamp,
                             _layer);
            else
                state.stop(*character, _layer);
        }
    }
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
