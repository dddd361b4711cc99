// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/WornGarment.h>

#include <osg/Group>
#include <osg/Node>
#include <osg/observer_ptr>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The meshes of a garment, bound to the palette of a body.
struct FittedGarment : WornGarment
{
    std::shared_ptr<const AnimationSet> set;           ///< the body's, with the further entries of the garment
    std::vector<osg::ref_ptr<SkinnedGeometry>> meshes; ///< share the garment's arrays, apart from palette entries
};

/// The garments that a character and its clones wear. Characters that wear the same garment share its meshes, and the
/// set if it has further palette entries, so that they are posed and drawn together. Safe to use from several threads.
///
/// A garment is a node, and whatever has the same meshes: clones of the node. Its identifier is a random text, a user
/// value of its worn meshes: OSG's own serializers store it, so characters of stored scenes know which meshes belong
/// together.
class Wardrobe
{
public:
    using Meshes = std::vector<const SkinnedGeometry*>;

    /// garment: its node. set, meshes: its own. body: the set of the body with the garments that it wears already.
    /// Errors: see AnimatedCharacter::wear().
    Result<FittedGarment> fit(const osg::Node& garment, const AnimationSet& set, const Meshes& meshes,
                              const std::shared_ptr<const AnimationSet>& body);
    /// The identifier of a garment, as for fit(). Empty: nobody has worn it.
    std::string identifierOf(const osg::Node& garment, const Meshes& meshes) const;
    /// That of the garment of a worn mesh. Empty: the mesh is the body's own.
    static std::string identifierOf(const osg::Object& mesh);

    /// The set without the last garments, as far as none of the meshes refers to their palette entries.
    static std::shared_ptr<const AnimationSet> withoutUnused(const std::shared_ptr<const AnimationSet>& set,
                                                             const osg::Group& meshes);
    /// The bounds, which are computed once for equal sets and meshes.
    std::shared_ptr<const ClipBoxes> boxes(const Meshes& meshes, const std::shared_ptr<const AnimationSet>& set);

private:
    using ObservedMeshes = std::vector<osg::observer_ptr<const SkinnedGeometry>>;

    struct Garment
    {
        osg::observer_ptr<const osg::Node> node;
        ObservedMeshes meshes;
        std::string identifier;
    };
    struct Fitting
    {
        std::string identifier; ///< of the garment
        ObservedMeshes sources;
        std::weak_ptr<const AnimationSet> body, set;
        std::vector<osg::observer_ptr<SkinnedGeometry>> meshes;
        FittedGarment fitted; ///< without set and meshes

        bool restore(FittedGarment& out) const; ///< false: something no longer exists
    };
    struct Outfit
    {
        ObservedMeshes meshes;
        std::weak_ptr<const AnimationSet> set;
        std::shared_ptr<const ClipBoxes> boxes;
    };

    const Garment* find(const osg::Node& garment, const Meshes& meshes) const;
    std::string identifierFor(const osg::Node& garment, const Meshes& meshes);

    mutable std::mutex _mutex;
    std::vector<Garment> _garments;
    std::vector<Fitting> _fittings;
    std::vector<Outfit> _outfits;
};

} // namespace osgGpuAnimation
