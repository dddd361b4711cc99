// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CharacterProgram.h>

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

// Nothing of it is written: reading gives the one that all characters share.
REGISTER_OBJECT_WRAPPER(osgGpuAnimation_CharacterProgram, characterProgram().release(),
                        osgGpuAnimation::CharacterProgram, "osgGpuAnimation::CharacterProgram")
{
}

} // namespace osgGpuAnimation::serializers
