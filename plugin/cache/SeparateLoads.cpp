// SPDX-License-Identifier: MIT
#include "cache/SeparateLoads.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osgDB/Registry>

namespace osgGpuAnimation
{

namespace
{

bool isOwn(const osg::Node& node)
{
    return dynamic_cast<const AnimatedCharacter*>(&node) || dynamic_cast<const AnimatedCrowd*>(&node);
}

SeparateLoads::Result separated(const SeparateLoads::Result& read, const osgDB::Options* options, int hint)
{
    SeparateLoads::Result result = read;
    osg::Node* node = result.getNode();
    if (!node || !options || (options->getObjectCacheHint() & hint) == 0) return result;
    if (!visitUntil(*node, isOwn)) return result;
    return SeparateLoads::Result(osg::clone(node, osg::CopyOp::DEEP_COPY_NODES), result.status());
}

} // namespace

SeparateLoads::Installation::Installation()
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    if (!registry || registry->getReadFileCallback()) return;
    _callback = new SeparateLoads;
    registry->setReadFileCallback(_callback);
}

SeparateLoads::Installation::~Installation()
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    if (registry && _callback && registry->getReadFileCallback() == _callback) registry->setReadFileCallback(nullptr);
}

SeparateLoads::Result SeparateLoads::readObject(const std::string& file, const osgDB::Options* options)
{
    return separated(osgDB::ReadFileCallback::readObject(file, options), options, osgDB::Options::CACHE_OBJECTS);
}

SeparateLoads::Result SeparateLoads::readNode(const std::string& file, const osgDB::Options* options)
{
    return separated(osgDB::ReadFileCallback::readNode(file, options), options, osgDB::Options::CACHE_NODES);
}

} // namespace osgGpuAnimation
