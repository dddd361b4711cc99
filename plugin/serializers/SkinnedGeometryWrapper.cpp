// SPDX-License-Identifier: MIT
#include "serializers/RequiredProperty.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

namespace
{

void writeArray(ValueWriter& out, const char* name, const osg::Array* array)
{
    out.open(name, array ? 1 : 0);
    if (array) out.object(array);
    out.close();
}

template <typename Array>
osg::ref_ptr<Array> readArray(ValueReader& in, const char* name)
{
    osg::ref_ptr<Array> array;
    if (in.open(name) > 0) array = in.objectOf<Array>();
    in.close();
    return array;
}

} // namespace

// Influences are vertex attributes, which OSG has written; this is where they count.
static bool writeInfluences(osgDB::OutputStream& stream, const SkinnedGeometry& mesh)
{
    ValueWriter(stream).integer(mesh.rigidEntry()).endLine();
    return true;
}

static bool readInfluences(osgDB::InputStream& stream, SkinnedGeometry& mesh)
{
    ValueReader in(stream);
    const std::int32_t rigidEntry = in.integer("a rigid mesh's palette entry", -1, 65535);
    if (!in.isGood()) return false;
    if (rigidEntry >= 0)
    {
        mesh.setRigidEntry(static_cast<unsigned short>(rigidEntry));
        return true;
    }
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets && mesh.entries(i) && mesh.weights(i); ++i)
        mesh.setInfluences(i, const_cast<osg::Vec4usArray*>(mesh.entries(i)),
                           const_cast<osg::Vec4Array*>(mesh.weights(i)));
    return true;
}

static bool checkMorphTargets(const SkinnedGeometry& mesh)
{
    return !mesh.morphTargets().empty();
}

static bool writeMorphTargets(osgDB::OutputStream& stream, const SkinnedGeometry& mesh)
{
    ValueWriter out(stream);
    out.integer(mesh.morph()).integer(mesh.morphEntry()).endLine();
    out.open("Targets", mesh.morphTargets().size());
    for (const MorphTarget& target : mesh.morphTargets())
    {
        writeArray(out, "Positions", target.positions);
        writeArray(out, "Normals", target.normals);
        writeArray(out, "Colors", target.colors);
        writeArray(out, "TextureCoordinates", target.textureCoordinates);
    }
    out.close();
    return true;
}

static bool readMorphTargets(osgDB::InputStream& stream, SkinnedGeometry& mesh)
{
    ValueReader in(stream);
    const std::int32_t morph = in.integer();
    const std::int32_t entry = in.integer();
    std::vector<MorphTarget> targets;
    const std::size_t count = in.open("Targets");
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
    {
        MorphTarget target;
        target.positions = readArray<osg::Vec3Array>(in, "Positions");
        target.normals = readArray<osg::Vec3Array>(in, "Normals");
        target.colors = readArray<osg::Vec4Array>(in, "Colors");
        target.textureCoordinates = readArray<osg::Vec2Array>(in, "TextureCoordinates");
        targets.push_back(std::move(target));
    }
    in.close();
    if (in.isGood()) mesh.setMorphTargets(morph, entry, std::move(targets));
    return in.isGood();
}

// Scenes of older versions may say when a mesh is skinned: the value is read and dropped.
static bool checkSkinning(const SkinnedGeometry&)
{
    return false;
}

static bool writeSkinning(osgDB::OutputStream&, const SkinnedGeometry&)
{
    return true;
}

static bool readSkinning(osgDB::InputStream& stream, SkinnedGeometry&)
{
    ValueReader in(stream);
    in.integer("when a mesh is skinned", 0, 2);
    return in.isGood();
}

REGISTER_OBJECT_WRAPPER(osgGpuAnimation_SkinnedGeometry, new SkinnedGeometry, osgGpuAnimation::SkinnedGeometry,
                        "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Drawable osg::Geometry "
                        "osgGpuAnimation::SkinnedGeometry")
{
    ADD_REQUIRED_SERIALIZER(Influences);
    ADD_USER_SERIALIZER(MorphTargets);
    ADD_USER_SERIALIZER(Skinning);
}

} // namespace osgGpuAnimation::serializers
