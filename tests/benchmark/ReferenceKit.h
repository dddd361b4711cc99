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

namespace osgGpuAnimation
{
class SkinnedGeometry;
}

namespace osgGpuAnimation::benchmark
{

/// How osgAnimation skins its characters.
enum class ReferenceMode
{
    Bones,         ///< no skinning and no meshes
    Software,      ///< RigTransformSoftware
    Hardware,      ///< RigTransformHardware, one program per mesh for all characters
    HardwareApart, ///< RigTransformHardware, one program per mesh and character, as in OSG's examples
};

/// One character animated by osgAnimation.
struct ReferenceCharacter
{
    osg::ref_ptr<osgAnimation::Skeleton> skeleton;             ///< its matrix is the placement
    std::vector<osg::ref_ptr<osgAnimation::Bone>> boneOfEntry; ///< one per palette entry; null if it is not needed
};

/// Builds a subject's characters with osgAnimation from the same joints, keyframes and meshes. The characters share
/// everything that osgAnimation can share: keyframes, influence maps, source geometries (software), vertex arrays and
/// one program per mesh (hardware). They have only the played clip, only channels that change a value, and only stacked
/// transforms that are not the identity. Rigid meshes are plain geometry below their bones.
///
/// Each bone corresponds to a palette entry, so that its matrices can be compared with the palette.
class ReferenceKit
{
public:
    explicit ReferenceKit(const Subject& subject);

    ReferenceCharacter make(ReferenceMode mode, double phase) const;

private:
    struct SharedMesh
    {
        osg::ref_ptr<osg::Geometry> source; ///< in bind pose, drawn without skinning
        osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences;
        osg::ref_ptr<osg::Program> hardwareProgram;
        int rigidEntry = -1; ///< the bone of a rigid mesh; -1: the mesh is skinned
    };

    void shareChannels(std::size_t joint);
    void shareMesh(const gltf::ImportedPrimitive& primitive);
    osg::ref_ptr<osgAnimation::Bone> makeBone(std::size_t entry) const;
    osg::ref_ptr<osgAnimation::Animation> makeAnimation(double phase) const;
    void addMeshes(ReferenceCharacter& character, ReferenceMode mode) const;
    osg::ref_ptr<osg::Geometry> makeRig(const SharedMesh& mesh, ReferenceMode mode) const;

    const Subject& _subject;
    std::vector<bool> _isNeeded;                                ///< by palette entry: true if it needs a bone
    std::vector<osg::ref_ptr<osgAnimation::Channel>> _channels; ///< each character has clones
    std::vector<SharedMesh> _meshes;
};

/// The shading of a mesh without skinning.
enum class Shading
{
    AsCharacters, ///< as the kit's own program draws it
    Least,        ///< the position and one colour: the cheapest way to draw the triangles
};

/// The mesh in bind pose with the same state and without skinning: the baseline of the skinning cost.
osg::ref_ptr<osg::Geometry> unskinned(const SkinnedGeometry& geometry, Shading shading);

/// The largest difference between the matrices of the character's bones and their palette entries, relative to the
/// largest element of the entries.
double largestDifference(const ReferenceCharacter& character, const std::vector<AffineMatrix>& palette);

} // namespace osgGpuAnimation::benchmark
