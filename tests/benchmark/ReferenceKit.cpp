// SPDX-License-Identifier: MIT
#include "ReferenceKit.h"
#include <osgGpuAnimation/animation/Channel.h>

#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osgAnimation/Channel>
#include <osgAnimation/RigTransformHardware>
#include <osgAnimation/Sampler>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <osg/Material>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// The vertex shader for osgAnimation's hardware mode, with its attribute names; the number of bones replaces
/// MAX_MATRIX.
constexpr const char* hardwareVertexShader = R"(#version 140
#extension GL_ARB_compatibility : enable
uniform mat4 matrixPalette[MAX_MATRIX];
uniform uint nbBonesPerVertex;
in vec4 boneWeight0;
in vec4 boneWeight1;
out vec3 viewPosition;
out vec3 viewNormal;
out vec4 vertexColor;
out vec2 textureCoordinate;

void main()
{
    mat4 matrix = boneWeight0.y * matrixPalette[int(boneWeight0.x)] + boneWeight0.w * matrixPalette[int(boneWeight0.z)];
    if (nbBonesPerVertex > 2u)
        matrix += boneWeight1.y * matrixPalette[int(boneWeight1.x)] + boneWeight1.w * matrixPalette[int(boneWeight1.z)];
    vec4 vertex = matrix * gl_Vertex;
    viewPosition = (gl_ModelViewMatrix * vertex).xyz;
    viewNormal = gl_NormalMatrix * (mat3(matrix) * gl_Normal);
    vertexColor = gl_Color;
    textureCoordinate = gl_MultiTexCoord0.xy;
    gl_Position = gl_ModelViewProjectionMatrix * vertex;
}
)";

constexpr const char* leastVertexShader = R"(#version 140
#extension GL_ARB_compatibility : enable
void main()
{
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
}
)";

constexpr const char* leastFragmentShader = R"(#version 140
out vec4 fragmentColor;
void main()
{
    fragmentColor = vec4(1.0);
}
)";

/// The permutation of the kit's program for meshes that do not move, as the kit selects it for the mesh in these
/// scenes: one distant light.
osg::ref_ptr<osg::Program> unskinnedProgram(const osg::Geometry& mesh)
{
    static const osg::ref_ptr<ShaderPermutations> permutations = new ShaderPermutations;
    ShaderKey surface;
    const osg::Uniform* flatNormals = mesh.getStateSet() ? mesh.getStateSet()->getUniform("flatNormals") : nullptr;
    if (flatNormals) flatNormals->get(surface.hasFlatNormals);
    return permutations->variant(surface);
}

/// That permutation's fragment shader behind another vertex shader.
osg::ref_ptr<osg::Program> makeProgram(const osg::Geometry& mesh, const std::string& vertex)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
    const osg::ref_ptr<osg::Program> unskinned = unskinnedProgram(mesh);
    for (unsigned int i = 0; i < unskinned->getNumShaders(); ++i)
        if (unskinned->getShader(i)->getType() == osg::Shader::FRAGMENT) program->addShader(unskinned->getShader(i));
    return program;
}

/// The cheapest program that draws the triangles: the position and one colour.
osg::Program* leastProgram()
{
    static const osg::ref_ptr<osg::Program> program = new osg::Program;
    if (program->getNumShaders() > 0) return program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, leastVertexShader));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, leastFragmentShader));
    return program;
}

std::string boneName(std::size_t entry)
{
    return "entry " + std::to_string(entry);
}

osg::Vec3 toVec3(const glm::vec4& v)
{
    return {v.x, v.y, v.z};
}

osg::Quat toQuat(const glm::vec4& q)
{
    return {q.x, q.y, q.z, q.w};
}

/// The values of a joint at each keyframe of the clip. If the first one is after time 0, a copy at 0 precedes it,
/// because osgAnimation plays from the first keyframe on.
template <typename Channel, typename Convert>
osg::ref_ptr<osgAnimation::Channel> makeChannel(const Clip& clip, std::size_t joint, const std::string& bone,
                                                const char* name, Convert convert)
{
    using Key = typename Channel::KeyframeContainerType::KeyType;
    osg::ref_ptr<Channel> channel = new Channel;
    channel->setName(name);
    channel->setTargetName(bone);
    auto& keyframes = *channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    if (clip.times().front() > 0.0f) keyframes.push_back(Key(0.0, convert(*clip.at(0, joint))));
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
        keyframes.push_back(Key(static_cast<double>(clip.times()[keyframe]), convert(*clip.at(keyframe, joint))));
    return channel;
}

} // namespace

ReferenceKit::ReferenceKit(const Subject& subject) : _subject(subject), _isNeeded(subject.set().paletteSize())
{
    const AnimationSet& set = subject.set();
    for (std::size_t entry = 0; entry < set.paletteSize(); ++entry)
        _isNeeded[entry] = set.palette()[entry].kind == PaletteEntry::Kind::Joint;
    for (const gltf::ImportedPrimitive& primitive : subject.model.primitives)
        shareMesh(primitive);
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
        shareChannels(joint);
}

void ReferenceKit::shareChannels(std::size_t joint)
{
    const AnimationSet& set = _subject.set();
    const Clip& clip = set.clips()[_subject.clip];
    const std::string bone = boneName(static_cast<std::size_t>(set.mainEntry(static_cast<int>(joint))));
    const auto shareVectors = [&](glm::vec4 JointTransform::*part, const char* name)
    {
        const auto convert = [part](const JointTransform& t) { return toVec3(t.*part); };
        if (isDriven(set, clip, joint, part))
            _channels.push_back(makeChannel<osgAnimation::Vec3LinearChannel>(clip, joint, bone, name, convert));
    };
    shareVectors(&JointTransform::translation, "translate");
    shareVectors(&JointTransform::scale, "scale");
    const auto convert = [](const JointTransform& t) { return toQuat(t.rotation); };
    if (isDriven(set, clip, joint, &JointTransform::rotation))
        _channels.push_back(
            makeChannel<osgAnimation::QuatSphericalLinearChannel>(clip, joint, bone, "rotate", convert));
}

void ReferenceKit::shareMesh(const gltf::ImportedPrimitive& primitive)
{
    const auto* skinned = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get());
    if (!skinned) return;
    SharedMesh mesh;
    mesh.source = unskinned(*skinned, Shading::AsCharacters);
    if (primitive.skin < 0)
    {
        const int joint = _subject.set().skeleton().jointOfSourceNode(primitive.node);
        if (joint < 0) return;
        mesh.rigidEntry = _subject.set().mainEntry(joint);
        _meshes.push_back(mesh);
        return;
    }
    mesh.influences = new osgAnimation::VertexInfluenceMap;
    for (unsigned int influenceSet = 0; influenceSet < SkinnedGeometry::maxInfluenceSets; ++influenceSet)
    {
        const osg::Vec4usArray* entries = skinned->getEntries(influenceSet);
        const osg::Vec4Array* weights = skinned->getWeights(influenceSet);
        for (unsigned int vertex = 0; entries && weights && vertex < entries->size(); ++vertex)
            for (int i = 0; i < 4; ++i)
            {
                const std::size_t entry = (*entries)[vertex][i];
                if (!((*weights)[vertex][i] > 1e-4f)) continue; // osgAnimation ignores smaller ones with a warning
                _isNeeded[entry] = true;
                osgAnimation::VertexInfluence& influence = (*mesh.influences)[boneName(entry)];
                influence.setName(boneName(entry));
                influence.emplace_back(vertex, (*weights)[vertex][i]);
            }
    }
    std::string source = hardwareVertexShader;
    // Replaced here: osgAnimation would replace it for each character and warn from the second one on.
    source.replace(source.find("MAX_MATRIX"), 10, std::to_string(mesh.influences->size()) + "/*MAX_MATRIX*/");
    mesh.hardwareProgram = makeProgram(*mesh.source, source);
    _meshes.push_back(mesh);
}

osg::ref_ptr<osgAnimation::Bone> ReferenceKit::makeBone(std::size_t entry) const
{
    const PaletteEntry& from = _subject.set().palette()[entry];
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(boneName(entry));
    bone->setInvBindMatrixInSkeletonSpace(toOsg(from.inverseBind));
    osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(boneName(entry));
    bone->setUpdateCallback(update);
    if (from.kind != PaletteEntry::Kind::Joint) return bone;
    const JointTransform& rest = _subject.set().restPose()[static_cast<std::size_t>(from.track)];
    osgAnimation::StackedTransform& stack = update->getStackedTransforms();
    stack.push_back(new osgAnimation::StackedTranslateElement("translate", toVec3(rest.translation)));
    stack.push_back(new osgAnimation::StackedQuaternionElement("rotate", toQuat(rest.rotation)));
    const Clip& clip = _subject.set().clips()[_subject.clip];
    const bool isScaled = toVec3(rest.scale) != osg::Vec3(1, 1, 1) ||
                          isDriven(_subject.set(), clip, static_cast<std::size_t>(from.joint), &JointTransform::scale);
    if (isScaled) stack.push_back(new osgAnimation::StackedScaleElement("scale", toVec3(rest.scale)));
    return bone;
}

osg::ref_ptr<osgAnimation::Animation> ReferenceKit::makeAnimation(double phase) const
{
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->setPlayMode(osgAnimation::Animation::LOOP);
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _channels)
        animation->addChannel(channel->clone()); // shares the keyframes
    animation->computeDuration();
    animation->setStartTime(-phase);
    return animation;
}

ReferenceCharacter ReferenceKit::make(ReferenceMode mode, double phase) const
{
    ReferenceCharacter character;
    character.skeleton = new osgAnimation::Skeleton;
    const std::vector<PaletteEntry>& palette = _subject.set().palette();
    for (std::size_t entry = 0; entry < palette.size(); ++entry)
    {
        character.boneOfEntry.push_back(_isNeeded[entry] ? makeBone(entry) : nullptr);
        if (!_isNeeded[entry]) continue;
        const int parent = palette[entry].parent;
        osg::Group* above = parent < 0 ? static_cast<osg::Group*>(character.skeleton.get())
                                       : character.boneOfEntry[static_cast<std::size_t>(parent)].get();
        above->addChild(character.boneOfEntry.back());
    }
    if (mode != ReferenceMode::Bones) addMeshes(character, mode);

    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager = new osgAnimation::BasicAnimationManager;
    osg::ref_ptr<osgAnimation::Animation> animation = makeAnimation(phase);
    manager->registerAnimation(animation);
    manager->playAnimation(animation);
    animation->setStartTime(-phase);
    // Order of the update callbacks: the manager, the skeleton's own callback, the bones below.
    manager->addNestedCallback(character.skeleton->getUpdateCallback());
    character.skeleton->setUpdateCallback(manager);
    return character;
}

void ReferenceKit::addMeshes(ReferenceCharacter& character, ReferenceMode mode) const
{
    for (const SharedMesh& mesh : _meshes)
        if (mesh.rigidEntry >= 0)
            character.boneOfEntry[static_cast<std::size_t>(mesh.rigidEntry)]->addChild(mesh.source);
        else
            character.skeleton->addChild(makeRig(mesh, mode));
}

osg::ref_ptr<osg::Geometry> ReferenceKit::makeRig(const SharedMesh& mesh, ReferenceMode mode) const
{
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setInfluenceMap(mesh.influences);
    rig->setSourceGeometry(mesh.source);
    if (mode == ReferenceMode::Software) return rig;
    // The rig takes its source's state set and adds its own palette to it, so each rig needs its own state set.
    osg::ref_ptr<osg::Geometry> source = new osg::Geometry(*mesh.source, osg::CopyOp::SHALLOW_COPY);
    source->setStateSet(new osg::StateSet(*mesh.source->getStateSet(), osg::CopyOp::SHALLOW_COPY));
    osg::ref_ptr<osg::Program> program = mesh.hardwareProgram;
    if (mode == ReferenceMode::HardwareApart) program = new osg::Program(*program, osg::CopyOp::DEEP_COPY_ALL);
    source->getStateSet()->setAttributeAndModes(program);
    rig->setSourceGeometry(source);
    rig->setRigTransformImplementation(new osgAnimation::RigTransformHardware);
    return rig;
}

osg::ref_ptr<osg::Geometry> unskinned(const SkinnedGeometry& geometry, Shading shading)
{
    osg::ref_ptr<osg::Geometry> plain = new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY);
    osg::Geometry::ArrayList none;
    plain->setVertexAttribArrayList(none);
    plain->setUseDisplayList(false);
    plain->setUseVertexBufferObjects(true);
    osg::ref_ptr<osg::StateSet> state = geometry.getStateSet()
                                            ? new osg::StateSet(*geometry.getStateSet(), osg::CopyOp::SHALLOW_COPY)
                                            : new osg::StateSet;
    const auto* material = dynamic_cast<const osg::Material*>(state->getAttribute(osg::StateAttribute::MATERIAL));
    const osg::Vec4 white(1, 1, 1, 1);
    state->addUniform(
        new osg::Uniform("materialDiffuse", material ? material->getDiffuse(osg::Material::FRONT) : white));
    if (geometry.getColors() != SkinnedGeometry::Colors::White) state->setDefine("POSE_COLORED", "1");
    osg::ref_ptr<osg::Program> program = leastProgram();
    if (shading == Shading::AsCharacters) program = unskinnedProgram(geometry);
    state->setAttributeAndModes(program);
    plain->setStateSet(state);
    return plain;
}

double largestDifference(const ReferenceCharacter& character, const std::vector<AffineMatrix>& palette)
{
    double largest = 0.0;
    double size = 1.0;
    for (std::size_t entry = 0; entry < std::min(palette.size(), character.boneOfEntry.size()); ++entry)
    {
        const osgAnimation::Bone* bone = character.boneOfEntry[entry].get();
        if (!bone) continue;
        const osg::Matrixd ours = toOsg(palette[entry]);
        const osg::Matrixd theirs = bone->getInvBindMatrixInSkeletonSpace() * bone->getMatrixInSkeletonSpace();
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column)
            {
                size = std::max(size, std::abs(ours(row, column)));
                largest = std::max(largest, std::abs(ours(row, column) - theirs(row, column)));
            }
    }
    return largest / size;
}

} // namespace osgGpuAnimation::benchmark
