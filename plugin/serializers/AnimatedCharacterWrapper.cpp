// SPDX-License-Identifier: MIT
#include "serializers/MeshCheck.h"
#include "serializers/RequiredProperty.h"
#include "serializers/StoredAnimationSet.h"
#include "serializers/StoredController.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

/// Its callbacks are those of the file.
static AnimatedCharacter* makeCharacter()
{
    AnimatedCharacter* character = new AnimatedCharacter;
    character->setUpdateCallback(nullptr);
    return character;
}

static bool writeAnimationSet(osgDB::OutputStream& stream, const AnimatedCharacter& character)
{
    ValueWriter out(stream);
    writeSet(out, character.controller().sharedSet());
    return true;
}

static bool readAnimationSet(osgDB::InputStream& stream, AnimatedCharacter& character)
{
    ValueReader in(stream);
    const std::shared_ptr<const AnimationSet> set = readSet(in);
    if (!set) return false;
    const Result<bool> taken = character.setAnimationSet(set);
    if (!taken) in.fail(taken.error().message);
    removeUnfitMeshes(character, *set);
    return in.isGood();
}

/// What is not as by default, one bit each; older readers know those that come first.
enum Extra : std::int32_t
{
    hasClipBounds = 1, ///< which are worked out again
    hasPixelError = 2, ///< which follows
    isDrawnAlone = 4,
};

static std::int32_t extrasOf(const AnimatedCharacter& character)
{
    std::int32_t extras = character.clipBounds(-1).empty() ? 0 : hasClipBounds;
    if (character.pixelError() > 0.0f) extras |= hasPixelError;
    if (!character.isDrawnTogether()) extras |= isDrawnAlone;
    return extras;
}

static bool checkExtras(const AnimatedCharacter& character)
{
    return extrasOf(character) != 0;
}

static bool writeExtras(osgDB::OutputStream& stream, const AnimatedCharacter& character)
{
    ValueWriter out(stream);
    const std::int32_t extras = extrasOf(character);
    out.integer(extras);
    if (extras & hasPixelError) out.real(static_cast<double>(character.pixelError()));
    out.endLine();
    return true;
}

static bool readExtras(osgDB::InputStream& stream, AnimatedCharacter& character)
{
    ValueReader in(stream);
    const std::int32_t extras = in.integer("what a character has", 0, hasClipBounds | hasPixelError | isDrawnAlone);
    const double pixelError = extras & hasPixelError ? in.real() : 0.0;
    if (!in.isGood()) return false;
    character.setDrawnTogether(!(extras & isDrawnAlone));
    if (extras & hasClipBounds) character.computeClipBounds();
    const Result<bool> taken = character.setPixelError(static_cast<float>(pixelError));
    if (!taken) in.fail("a character: " + taken.error().message);
    return in.isGood();
}

static bool writeController(osgDB::OutputStream& stream, const AnimatedCharacter& character)
{
    ValueWriter out(stream);
    writeController(out, character.controller());
    return true;
}

static bool readController(osgDB::InputStream& stream, AnimatedCharacter& character)
{
    ValueReader in(stream);
    readController(in, character.controller());
    character.dirtyBound();
    return in.isGood();
}

REGISTER_OBJECT_WRAPPER(osgGpuAnimation_AnimatedCharacter, makeCharacter(), osgGpuAnimation::AnimatedCharacter,
                        "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform "
                        "osg::MatrixTransform osgGpuAnimation::AnimatedCharacter")
{
    ADD_REQUIRED_SERIALIZER(AnimationSet);
    // In files they have the name of the first of them.
    wrapper->addSerializer(new osgDB::UserSerializer<MyClass>("ClipBounds", &checkExtras, &readExtras, &writeExtras),
                           osgDB::BaseSerializer::RW_USER);
    ADD_REQUIRED_SERIALIZER(Controller);
}

} // namespace osgGpuAnimation::serializers
