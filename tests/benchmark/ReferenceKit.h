// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <osgAnimation/Animation>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/VertexInfluence>

#include <vector>

namespace osgGpuAnimation::benchmark
{

/// How osgAnimation's characters are skinned.
enum class ReferenceMode
{
    Bones,         ///< not at all: no meshes
    Software,      ///< RigTransformSoftware
    Hardware,      ///< RigTransformHardware, one program a mesh for all characters
    HardwareApart, ///< RigTransformHardware, a program for each character's mesh, as OSG's own examples have it
};

/// One character as osgAnimation has it.
struct ReferenceCharacter
{
    osg::ref_ptr<osgAnimation::Skeleton> skeleton;             ///< its matrix places it
    std::vector<osg::ref_ptr<osgAnimation::Bone>> boneOfEntry; ///< one a palette entry; null where none is needed
};

/// Builds a subject's characters with osgAnimation, from the same joints, keyframes and meshes. What osgAnimation lets
/// characters share is shared: keyframes, influence maps, source geometries (software), vertex arrays and one program a
/// mesh (hardware). Only the clip that is played is there, only channels that move something, and only the stacked
/// transforms that are not the identity; rigid meshes hang below their bones as plain geometry.
///
/// A bone stands for a palette entry, so that its matrices can be compared with the palette.
class ReferenceKit
{
public:
    explicit ReferenceKit(const Subject& subject);

    ReferenceCharacter make(ReferenceMode mode, double phase);

private:
    struct SharedChannel
    {
        int entry;
        const char* name;
        osg::ref_ptr<osgAnimation::Vec3KeyframeContainer> vectors; ///< of translations and scales
        osg::ref_ptr<osgAnimation::QuatKeyframeContainer> rotations;
    };
    struct SharedMesh
    {
        osg::ref_ptr<osg::Geometry> source; ///< in bind pose, drawn without skinning
        osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences;
        osg::ref_ptr<osg::Program> hardwareProgram;
        int rigidEntry = -1; ///< where it hangs on one bone
    };

    void shareChannels(std::size_t joint);
    void shareMesh(const gltf::ImportedPrimitive& primitive);
    osg::ref_ptr<osgAnimation::Bone> makeBone(std::size_t entry) const;
    osg::ref_ptr<osgAnimation::Animation> makeAnimation(double phase) const;
    void addMeshes(ReferenceCharacter& character, ReferenceMode mode) const;
    osg::ref_ptr<osg::Geometry> makeRig(const SharedMesh& mesh, ReferenceMode mode) const;

    const Subject& _subject;
    std::vector<bool> _isNeeded; ///< of the entries: is there a bone?
    std::vector<SharedChannel> _channels;
    std::vector<SharedMesh> _meshes;
};

/// How a mesh is drawn that is not skinned.
enum class Shading
{
    AsCharacters, ///< as the kit's own program draws it
    Least,        ///< the position and one colour: what no way to draw its triangles can do without
};

/// The mesh in bind pose with the same state, its program drawing it as it is: what skinning is measured against.
osg::ref_ptr<osg::Geometry> unskinned(const osg::Geometry& geometry, Shading shading);

/// The largest distance between the character's bones and the palette entries they stand for, by the size of what the
/// entries move.
double largestDifference(const ReferenceCharacter& character, const std::vector<AffineMatrix>& palette);

} // namespace osgGpuAnimation::benchmark
