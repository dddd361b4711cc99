// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>

#include <osg/StateAttribute>

#include <limits>
#include <memory>

namespace osgGpuAnimation
{

/// Selects the palettes for the SkinnedGeometry below it in the state graph of one frame: instances in a PoseBatch of
/// that frame. PoseFrame creates it; SkinnedGeometry reads it when it draws.
class PaletteBinding : public osg::StateAttribute
{
public:
    static constexpr Type bindingType = static_cast<Type>(119); ///< beyond OSG's own types, within the enum's range

    static constexpr int allTriangles = std::numeric_limits<int>::min(); ///< the level LodLevels::allTriangles

    PaletteBinding() = default;
    PaletteBinding(const PaletteBinding& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_StateAttribute(osgGpuAnimation, PaletteBinding, bindingType)

    /// Selects instanceCount consecutive instances at the draw's own model-view matrix, with all triangles.
    void set(std::shared_ptr<const AnimationSet> set, std::size_t slot, std::size_t instance,
             std::size_t instanceCount = 1);
    /// Selects instances of a crowd: [first, first + count) of placed.drawn, whose poses are indices of the batch.
    void setPlaced(std::shared_ptr<const AnimationSet> set, std::size_t slot,
                   std::shared_ptr<const PlacedInstances> placed, std::size_t first, std::size_t count);
    const std::shared_ptr<const PlacedInstances>& getPlaced() const { return _placed; } ///< null: there is no list
    /// The level of detail; set() and setInstanced() reset it to all triangles.
    void setLevel(int level) { _level = level; }
    int getLevel() const { return _level; }
    /// Selects instances with a placement each, for an instanced draw; add() adds lists of them, which may grow until
    /// the draw.
    void setInstanced(std::shared_ptr<const AnimationSet> set, std::size_t slot);
    void add(InstanceLists::value_type list) { _lists.push_back(std::move(list)); }
    const InstanceLists& getInstanceLists() const { return _lists; }
    /// False: the instances use the draw's model-view matrix.
    bool isInstanced() const { return _serial != 0; }

    const AnimationSet* getAnimationSet() const { return _set.get(); }
    std::size_t getSlot() const { return _slot; }
    std::size_t getInstance() const { return _instance; }           ///< the first
    std::size_t getInstanceCount() const { return _instanceCount; } ///< consecutive
    /// The number of drawn instances, with placements or without.
    std::size_t getDrawnCount() const;

    int compare(const osg::StateAttribute& other) const override;
    void apply(osg::State&) const override {}

protected:
    ~PaletteBinding() override = default;

private:
    std::shared_ptr<const AnimationSet> _set;
    std::size_t _slot = 0;
    std::size_t _instance = 0;
    std::size_t _instanceCount = 1;
    InstanceLists _lists;
    std::shared_ptr<const PlacedInstances> _placed;
    std::uint64_t _serial = 0; ///< of setInstanced(), for compare(); 0: none
    int _level = allTriangles;
};

} // namespace osgGpuAnimation
