// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/SurfaceProgram.h>

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

// Nothing of it is written: reading gives the one that all characters share.
REGISTER_OBJECT_WRAPPER(osgGpuAnimation_SurfaceProgram, characterProgram().release(), osgGpuAnimation::SurfaceProgram,
                        "osgGpuAnimation::SurfaceProgram")
{
}

} // namespace osgGpuAnimation::serializers
