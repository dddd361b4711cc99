// SPDX-License-Identifier: MIT
#include "Field.h"

#include "PoseCrowd.h"

#include <map>
#include <random>
#include <string>

namespace osgGpuAnimation::benchmark
{

double spacingOf(const Subject& subject)
{
    const std::map<std::string, double> known{{"Fox", 110.0}, {"CesiumMan", 1.1}, {"Knight", 2.2}, {"Wanderer", 1.1}};
    const auto bar = known.find(subject.name);
    return bar == known.end() ? 1.3 * subject.model.root->getBound().radius() : bar->second;
}

osg::ref_ptr<AnimatedCrowd> makeField(const Subject& subject, std::size_t step)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*subject.model.character);
    const double spacing = spacingOf(subject);
    std::mt19937 random(1);
    for (std::size_t place = 0; place < places; place += step)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        static_cast<void>(controller.play(random() % subject.set().clips().size()));
        controller.seek(phaseOf(place, controller.duration()));
        const double x = spacing * static_cast<double>(place % columns);
        const double y = spacing * static_cast<double>(place / columns);
        static_cast<void>(crowd->add(osg::Matrixd::translate(x, y, 0.0), controller));
    }
    return crowd;
}

void lookAcross(StagedViewer& viewer, const osg::BoundingSphere& field)
{
    const osg::Vec3d centre = field.center();
    viewer.lookFrom(centre + osg::Vec3d(0.0, -0.74, 0.06) * field.radius(), centre, 30.0);
}

} // namespace osgGpuAnimation::benchmark
