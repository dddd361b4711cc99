// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/Mipmaps.h>

namespace osgGpuAnimation
{

void generateMipmaps(osg::Texture& texture)
{
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    if (filter != osg::Texture::LINEAR && filter != osg::Texture::NEAREST) texture.allocateMipmapLevels();
}

void generateMipmaps(osg::StateSet* state)
{
    for (unsigned int unit = 0; state && unit < state->getNumTextureAttributeLists(); ++unit)
        if (auto* texture = dynamic_cast<osg::Texture*>(state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE)))
            generateMipmaps(*texture);
}

} // namespace osgGpuAnimation
