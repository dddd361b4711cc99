// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

class AnimatedProperties;
class AnimationController;
class CharacterLevels;
class OutfitMeshes;
class LevelsTask;
class VariantMeshes;

/// The meshes of an AnimatedCharacter, or of all instances of an AnimatedCrowd: which are visible, in which variant of
/// the file's materials, and with how many triangles. Instances that show other meshes or another variant are a crowd
/// of their own.
///
///     knight->getMeshes().setVisible("1H_Sword", false);
///     shoe->getMeshes().setVariant("midnight");
///     crowd->getMeshes().setPixelError(0.5f);
///
/// Each primitive of a glTF file is a mesh here (glTF 2.0, section 3.7.4). It has the name of the file's node; of the
/// file's mesh if the node has none. Its StateSet has the name of its material. The name of the file's mesh, where it
/// is another one, is the user value "osgGpuAnimation.mesh" (std::string).
///
/// Changes belong in the update traversal or between frames, and not into the cull of a crowd.
class CharacterMeshes
{
public:
    CharacterMeshes(const CharacterMeshes&) = delete;
    CharacterMeshes& operator=(const CharacterMeshes&) = delete;
    ~CharacterMeshes();

    /// The first mesh of that name among the node's children; if there is none, the first one of that name of the
    /// file's mesh. Null: neither exists. Clones share it.
    SkinnedGeometry* find(const std::string& name) const;
    /// Shows or hides all meshes of that name; if there are none, those of that name of the file's mesh. Clones show
    /// meshes of their own: a direct child that changes is replaced by another drawable over the same arrays, as with
    /// material variants. Bounds do not change. With a pixel error of a crowd, call setPixelError() again: it requests
    /// the levels of detail of what is visible now. Error: there is no such mesh; the message lists the names.
    Result<void> setVisible(const std::string& name, bool isVisible);

    /// Shows the meshes in a variant of the file's materials (glTF: KHR_materials_variants), whose maps the import has
    /// loaded. Clones show variants of their own; those that show the same one are drawn together. A direct child that
    /// the variant changes is replaced by another drawable over the same arrays. name: one of getVariants(); empty: the
    /// default materials. Error: another name; the message lists the names.
    Result<void> setVariant(const std::string& name);
    const std::string& getVariant() const { return _variant; } ///< the present one; empty: the default materials
    std::vector<std::string> getVariants() const;              ///< in the file's order, then those of garments

    /// Sets the largest error of the drawn surface on screen: meshes are drawn with fewer triangles while the error
    /// stays below it, see LodLevels. 0 (the default): all triangles. Each camera selects the level by distance, with
    /// the measure of small feature culling.
    /// The levels of the present meshes are made in the background, from copies of the meshes; an update traversal
    /// takes them. Until then, all triangles are drawn. Later changes of vertices or primitives have the same effect.
    /// No levels are made for meshes that are not direct children or for vertices beyond LodRange::maxVertices. A crowd
    /// draws instances of a few pixels as one mesh per material without textures, and those that loop one clip share
    /// poses as far as the error permits; 0: exact poses. pixels: in [0, LodRange::maxPixelError]. Error: pixels is out
    /// of range or NaN.
    Result<void> setPixelError(float pixels);
    float getPixelError() const { return _pixelError; } ///< pixels, at least 0
    /// Blocks until the levels of the present meshes exist, and takes them. For whoever renders single pictures,
    /// measures frames or compares levels; writers of .osgb, .osgt and .osgx call it. Returns at once without a pixel
    /// error. Call it where meshes may be changed.
    void waitForLevels();

private:
    friend class AnimatedCharacter;
    friend class AnimatedCrowd;
    friend struct CrowdDetail;

    /// node: their parent. set: the place where the node keeps its set. controller: of the character; null: a crowd.
    CharacterMeshes(osg::Group& node, const std::shared_ptr<const AnimationSet>& set,
                    const AnimationController* controller = nullptr);

    void copySettings(const CharacterMeshes& other); ///< other: of a node with the same meshes
    void forgetProperties();                         ///< after another set of the character
    void showVariant();                              ///< after the node has got further meshes
    void showProperties();                           ///< those of the controller's present pose
    const osg::Group& drawn() const;                 ///< the node, or the meshes of a crowd's outfits
    void showLevels();                               ///< after a change of the levels or outfits
    void updateLevels();                             ///< in the update traversal: takes or requests what is missing
    void requestLevels();                            ///< those that are missing, unless they are being made
    void requestPresentLevels();                     ///< the same, without those of earlier meshes
    void takeLevels();                               ///< of a task that is done
    bool isMissingLevels() const;                    ///< false without a pixel error
    template <typename Change>
    void change(Change change);

    osg::Group& _node;
    const std::shared_ptr<const AnimationSet>& _set; ///< the node's present one, never null
    const AnimationController* _controller;          ///< null: a crowd
    std::shared_ptr<VariantMeshes> _variantMeshes;   ///< never null, shared with clones and crowds
    std::unique_ptr<AnimatedProperties> _properties; ///< null: the set has none, or a crowd
    std::string _variant;
    float _pixelError = 0.0f;                       ///< pixels
    std::unique_ptr<OutfitMeshes> _outfits;         ///< of a crowd; null: there were none
    std::shared_ptr<const CharacterLevels> _levels; ///< of the crowd as a whole; null: not made
    std::shared_ptr<LevelsTask> _task;              ///< null: nothing is missing
};

} // namespace osgGpuAnimation
