// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>

#include <osg/Drawable>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Draws a mesh and keeps what selects its poses.
class BindingRecord : public osg::Drawable::DrawCallback
{
public:
    struct Draw
    {
        std::shared_ptr<const PlacedInstances> placed; ///< null: poses are not shared
        std::size_t slot, first, count;
        int level;
    };

    void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
    {
        drawable->drawImplementation(info);
        const auto* binding =
            static_cast<const PaletteBinding*>(info.getState()->getLastAppliedAttribute(PaletteBinding::bindingType));
        draws.push_back({binding->getPlaced(), binding->getSlot(), binding->getInstance(), binding->getDrawnCount(),
                         binding->getLevel()});
    }

    mutable std::vector<Draw> draws;
};

} // namespace osgGpuAnimation
