// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/PrimitiveRange.h>

namespace osgGpuAnimation
{

bool isWithin(const osg::PrimitiveSet* primitives, std::size_t vertices)
{
    if (!primitives) return false;
    if (const auto* const range = dynamic_cast<const osg::DrawArrays*>(primitives))
        return range->getFirst() >= 0 && range->getCount() >= 0 &&
               static_cast<std::size_t>(range->getFirst()) + static_cast<std::size_t>(range->getCount()) <= vertices;
    if (const auto* const ranges = dynamic_cast<const osg::DrawArrayLengths*>(primitives))
    {
        if (ranges->getFirst() < 0) return false;
        auto end = static_cast<std::size_t>(ranges->getFirst());
        for (const GLsizei length : *ranges)
        {
            if (length < 0) return false;
            end += static_cast<std::size_t>(length);
        }
        return end <= vertices;
    }
    using Set = osg::PrimitiveSet;
    const bool hasIndices = primitives->getType() == Set::DrawElementsUBytePrimitiveType ||
                            primitives->getType() == Set::DrawElementsUShortPrimitiveType ||
                            primitives->getType() == Set::DrawElementsUIntPrimitiveType;
    for (unsigned int i = 0; hasIndices && i < primitives->getNumIndices(); ++i)
        if (primitives->index(i) >= vertices) return false;
    return hasIndices;
}

} // namespace osgGpuAnimation
