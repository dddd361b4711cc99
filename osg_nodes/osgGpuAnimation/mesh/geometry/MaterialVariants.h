// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Group>
#include <osg/LOD>
#include <osg/observer_ptr>
#include <osg/StateSet>

#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation
{

// Material variants (glTF: KHR_materials_variants): a character has their names, and each mesh that they change has a
// StateSet for each. Both are user objects of the node, so that OSG's own serializers store them and copies share them.

/// The names of all variants, in the file's order.
void setVariantNames(osg::Object& character, const std::vector<std::string>& names);
std::vector<std::string> variantNamesOf(const osg::Object& character); ///< empty: none

struct VariantState
{
    std::string variant;
    osg::ref_ptr<osg::StateSet> state;
};

/// defaultState: of all variants that are not among the states. The mesh keeps its present StateSet.
void setVariantStates(osg::Geometry& mesh, osg::StateSet* defaultState, const std::vector<VariantState>& states);
/// The mesh's StateSet in a variant. Null: no variant changes the mesh.
osg::StateSet* variantState(const osg::Geometry& mesh, const std::string& variant);
/// For the StateSets that the mesh does not draw with at present. state: null: all contexts.
void releaseVariantStates(const osg::Geometry& mesh, osg::State* state);
void resizeVariantStates(osg::Geometry& mesh, unsigned int maxSize);

/// The meshes of a character and its clones in the variants that they show, and hidden. A mesh in another variant, or
/// a hidden one (with node mask 0), is a shallow copy of it, which exists once: characters that show the same share
/// their meshes and are drawn together.
class VariantMeshes
{
public:
    /// Replaces the meshes that the variant changes among the direct children of the group and of LODs there.
    void show(osg::Group& group, const std::string& variant);
    /// Replaces these meshes among the direct children of the group, and all levels of LODs there that have one. A
    /// hidden mesh gets the node mask that it or a copy of it had; ~0 if it has always been hidden.
    void setVisible(osg::Group& group, const std::vector<osg::Geometry*>& meshes, bool isVisible);

private:
    osg::ref_ptr<osg::Geometry> copyOf(osg::Geometry& mesh, osg::StateSet* state, bool isVisible);
    osg::Node::NodeMask visibleMask(const osg::Geometry& mesh) const;

    /// The user data that copies share, the StateSet, the node mask while it is visible, and whether it is.
    using Key = std::tuple<const osg::UserDataContainer*, const osg::StateSet*, osg::Node::NodeMask, bool>;
    std::mutex _mutex;
    std::map<Key, osg::observer_ptr<osg::Geometry>> _meshes;
};

} // namespace osgGpuAnimation
