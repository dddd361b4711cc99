// SPDX-License-Identifier: MIT
#include "serializers/RequiredProperty.h"
#include "serializers/StoredAnimationSet.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include "cache/SeparateLoads.h"

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

// Whatever of ours is read has a set.
static SeparateLoads::Installation separateLoads;

static bool readContents(osgDB::InputStream& stream, StoredAnimationSet& stored)
{
    ValueReader in(stream);
    stored.read(in);
    return in.isGood();
}

static bool writeContents(osgDB::OutputStream& stream, const StoredAnimationSet& stored)
{
    ValueWriter out(stream);
    stored.write(out);
    return true;
}

REGISTER_OBJECT_WRAPPER2(osgGpuAnimation_StoredAnimationSet, new StoredAnimationSet, StoredAnimationSet,
                         "osgGpuAnimation::StoredAnimationSet", "osgGpuAnimation::StoredAnimationSet")
{
    ADD_REQUIRED_SERIALIZER(Contents);
}

} // namespace osgGpuAnimation::serializers
