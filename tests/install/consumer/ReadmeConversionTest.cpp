// SPDX-License-Identifier: MIT
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>
#include <osgGpuAnimation/osganimation/SkeletonConversion.h>

#include <iostream>

// The guide sources.md, "Scenes of osgAnimation", statement by statement. The test `install.conversion` runs it. Exit
// status 0: the scene's skeleton has become a character with its bone.

int main()
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->addChild(new osgAnimation::Bone("hips"));
    scene->addChild(skeleton);

    auto converted = osgGpuAnimation::osganimation::convertOsgAnimation(*scene);
    for (const std::string& warning : converted.warnings)
        std::cerr << warning << std::endl;

    if (converted.node != scene || converted.characters.size() != 1 || !converted.warnings.empty()) return 1;
    return converted.characters[0]->getAnimationSet().skeleton().findJoint("hips") == 0 ? 0 : 1;
}
