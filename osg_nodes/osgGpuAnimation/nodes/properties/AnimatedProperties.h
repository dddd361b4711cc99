// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/properties/PropertyMarks.h>
#include <osgGpuAnimation/nodes/properties/PropertyPointer.h>

#include <osg/CameraView>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/LightSource>
#include <osg/StateSet>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class AnimationSet;
struct PoseInstruction;

// The properties of a file that clips animate beside joints and morph weights: factors and texture transforms of
// materials, lights, cameras, and the visibility of nodes. The set has their curves (see MorphWeights); the import
// marks the objects of the scene that they change.

/// The name of the user value (double, scene units) that an osg::CameraView has if its projection is parallel: the
/// height of what it shows. OSG's CameraView has only fields of view.
constexpr const char* orthographicHeightName = "orthographicHeight";

/// Sets the matrix that a material applies to its texture coordinates: a uniform and the define of character.vert.
/// number: of the coordinates, 0 to 2. offset, rotation (radians), scale: of KHR_texture_transform.
void setTextureTransform(osg::StateSet& stateSet, int number, const float* offset, float rotation, const float* scale);

/// Adds the meshes that are direct children of a character to a crowd. In place of those that the character animates,
/// copies over the same arrays, see UnanimatedMeshes. set: the character's.
void addUnanimated(const osg::Group& character, const AnimationSet& set, osg::Group& crowd);

/// The properties of one character. It writes to StateSets, lights and camera views of its own, so that copies of the
/// character show other times. A character whose set has no properties has none of these objects.
class AnimatedProperties
{
public:
    /// Null if the set has no properties.
    static std::unique_ptr<AnimatedProperties> of(const AnimationSet& set);

    /// Gives the character its own StateSets, lights and camera views in place of those that are marked. Direct
    /// children that other characters have too are replaced by copies over the same arrays. The next apply() sets all
    /// values.
    void bind(osg::Group& character);
    bool isBound() const { return _isBound; }
    /// Gives the meshes the node masks that the application gave them, so that it can change them. bind() must follow.
    void restoreMasks();

    /// Sets the values of the instruction. set: with the same morphs as that of the construction.
    void apply(const AnimationSet& set, const PoseInstruction& instruction);

private:
    friend class UnanimatedMeshes;
    struct Property
    {
        PropertyPointer pointer;
        std::size_t first; ///< of its numbers in _numbers
    };
    struct Light
    {
        int index; ///< -1: only its visibility is animated
        osg::ref_ptr<osg::LightSource> source;
        osg::ref_ptr<osg::Light> shown; ///< the light while it is visible
        std::vector<int> nodes;         ///< see markVisibility()
        bool isVisible = true;
    };
    struct Hidable
    {
        osg::ref_ptr<osg::Node> mesh;
        std::vector<int> nodes; ///< see markVisibility()
    };

    AnimatedProperties() = default;
    using OwnStates = std::map<const osg::StateSet*, osg::ref_ptr<osg::StateSet>>; ///< by the marked one
    void bindChildren(osg::Group& group, OwnStates& owned);
    void bindBelow(osg::Node& node);
    /// The numbers that are shown, first those at rest, or the default; within the member's range.
    std::array<float, 4> valueOf(const PropertyMember& member, int index) const;
    bool isVisible(const std::vector<int>& nodes) const;
    void setMaterial(osg::StateSet& state, const PropertyPointer& pointer) const;
    void setLight(Light& light, bool hasChanged) const;
    void setCamera(osg::CameraView& view, const PropertyPointer& pointer) const;

    std::vector<Property> _properties;
    std::map<std::pair<const PropertyMember*, int>, std::size_t> _firstNumbers; ///< by member and index, in _numbers
    std::vector<std::pair<int, osg::ref_ptr<osg::StateSet>>> _materials;        ///< with their indices
    std::vector<Light> _lights;
    std::vector<std::pair<int, osg::ref_ptr<osg::CameraView>>> _cameras; ///< with their indices
    std::vector<Hidable> _hidables;
    std::vector<float> _numbers, _shown; ///< of all properties
    bool _isBound = false;
    bool _hasApplicationMasks = false; ///< after restoreMasks()
};

/// Makes copies of the meshes of a character into meshes that no clip animates: for crowds, and for characters that
/// wear them. They show materials and visibility as they are at rest. Copies made by one object share StateSets as the
/// originals do.
class UnanimatedMeshes
{
public:
    explicit UnanimatedMeshes(const AnimationSet& set); ///< of the character
    ~UnanimatedMeshes();

    /// Removes the marks from a shallow copy of a mesh, which gets user data and StateSets of its own for it.
    void release(osg::Geometry& copy);

private:
    osg::StateSet* stateAtRest(osg::StateSet* state);

    std::unique_ptr<AnimatedProperties> _properties;                            ///< null: the set has none
    std::map<osg::ref_ptr<osg::StateSet>, osg::ref_ptr<osg::StateSet>> _states; ///< at rest, by the marked one
};

} // namespace osgGpuAnimation
