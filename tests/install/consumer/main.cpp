// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>

#include <iostream>

using osgGpuAnimation::AnimatedCharacter;
using osgGpuAnimation::findCharacter;

/// The README's ten lines. Usage: consumer MODEL CLIP. Exit status 0: a character and its clone play.
int main(int argumentCount, char** arguments)
{
    if (argumentCount != 3) return 2;
    osg::ref_ptr<osg::Group> scene = new osg::Group;

    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(arguments[1]);
    AnimatedCharacter* fox = node ? findCharacter(*node) : nullptr;
    if (!fox) return 1;
    if (auto faded = fox->getController().crossfade(arguments[2], 0.25); !faded)
    {
        std::cerr << faded.error().message << std::endl;
        return 1;
    }

    osg::ref_ptr<osg::Node> other = osg::clone(node.get(), osg::CopyOp::DEEP_COPY_NODES);
    findCharacter(*other)->getController().setSpeed(0.5);

    osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(100.0, 0.0, 0.0));
    beside->addChild(other);
    scene->addChild(node);
    scene->addChild(beside);

    std::cout << fox->getAnimationSet().clips()[fox->getController().clip()].name() << ", "
              << scene->getBound().radius() << std::endl;
    return scene->getBound().radius() > 50.0 ? 0 : 1;
}
