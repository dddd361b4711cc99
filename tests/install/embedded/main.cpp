// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <iostream>

USE_OSGPLUGIN(gltf)
USE_OSGPLUGIN(crowd)
#ifdef OSG_LIBRARY_STATIC // tests/ports/osg.sh static
USE_OSGPLUGIN(osg2)
USE_OSGPLUGIN(png)
USE_OSGPLUGIN(jpeg)
USE_SERIALIZER_WRAPPER_LIBRARY(osg)
#endif

/// Usage: embedded MODEL.glb SCENE.osgt. Exit status 0: the model is read by the plugins that are linked, and a scene
/// that was written keeps its character.
int main(int argumentCount, char** arguments)
{
    if (argumentCount != 3) return 2;
    const std::string model = arguments[1], scene = arguments[2];
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(model);
    const osg::ref_ptr<osg::Node> crowd = osgDB::readRefNodeFile(model + ".3x3.crowd");
    if (!node || !osgGpuAnimation::findCharacter(*node) || !crowd || !osgDB::writeNodeFile(*node, scene)) return 1;
    const osg::ref_ptr<osg::Node> kept = osgDB::readRefNodeFile(scene);
    if (!kept || !osgGpuAnimation::findCharacter(*kept)) return 1;
    std::cout << crowd->getBound().radius() / node->getBound().radius() << std::endl;
    return crowd->getBound().radius() > 2.0f * node->getBound().radius() ? 0 : 1;
}
