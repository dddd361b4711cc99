// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osg/StateAttribute>

#include <memory>

namespace osgGpuAnimation
{

/// Says, along the state graph of one frame, whose palette the SkinnedGeometry below is drawn from: a place in a
/// PoseBatch of that frame. Made by PoseFrame; applying it does nothing by itself.
class PaletteBinding : public osg::StateAttribute
{
public:
    static constexpr Type bindingType = static_cast<Type>(119); ///< beyond OSG's own types, within the enum's range

    PaletteBinding() = default;
    PaletteBinding(const PaletteBinding& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_StateAttribute(osgGpuAnimation, PaletteBinding, bindingType)

        void set(std::shared_ptr<const AnimationSet> set, std::size_t slot, std::size_t instance);
    const AnimationSet* animationSet() const { return _set.get(); }
    std::size_t slot() const { return _slot; }
    std::size_t instance() const { return _instance; }

    int compare(const osg::StateAttribute& other) const override;
    void apply(osg::State&) const override {}

protected:
    ~PaletteBinding() override = default;

private:
    std::shared_ptr<const AnimationSet> _set;
    std::size_t _slot = 0;
    std::size_t _instance = 0;
};

} // namespace osgGpuAnimation
