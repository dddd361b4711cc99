// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>
#include <osgGpuAnimation/nodes/lod/LodLevels.h>

#include <osg/StateAttribute>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Says, along the state graph of one frame, whose palettes the SkinnedGeometry below is drawn from: places in a
/// PoseBatch of that frame. Made by PoseFrame; applying it does nothing by itself.
class PaletteBinding : public osg::StateAttribute
{
public:
    static constexpr Type bindingType = static_cast<Type>(119); ///< beyond OSG's own types, within the enum's range

    PaletteBinding() = default;
    PaletteBinding(const PaletteBinding& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_StateAttribute(osgGpuAnimation, PaletteBinding, bindingType)

    void set(std::shared_ptr<const AnimationSet> set, std::size_t slot, std::size_t instance,
             std::size_t instanceCount = 1);
    /// At which level of detail the instances are drawn; set() and setPlaced() make it all triangles.
    void setLevel(int level) { _level = level; }
    int getLevel() const { return _level; }
    /// For instances that are drawn together, each at a placement of its own; there are none at first.
    void setPlaced(std::shared_ptr<const AnimationSet> set, std::size_t slot);
    void add(const InstanceTransform& placement) { _placements.push_back(placement); }
    const std::vector<InstanceTransform>& getInstanceTransforms() const { return _placements; }
    std::uint64_t getSerial() const
    {
        return _serial;
    } ///< of the list of placements; 0: instances stand where the draw does

    const AnimationSet* getAnimationSet() const { return _set.get(); }
    std::size_t getSlot() const { return _slot; }
    std::size_t getInstance() const { return _instance; }           ///< the first to be drawn
    std::size_t getInstanceCount() const { return _instanceCount; } ///< that are to be drawn, one after another
    /// Instances that a draw shows, whichever way.
    std::size_t getDrawnCount() const { return _serial != 0 ? _placements.size() : _instanceCount; }

    int compare(const osg::StateAttribute& other) const override;
    void apply(osg::State&) const override {}

protected:
    ~PaletteBinding() override = default;

private:
    std::shared_ptr<const AnimationSet> _set;
    std::size_t _slot = 0;
    std::size_t _instance = 0;
    std::size_t _instanceCount = 1;
    std::vector<InstanceTransform> _placements;
    std::uint64_t _serial = 0;
    int _level = LodLevels::allTriangles;
};

} // namespace osgGpuAnimation
