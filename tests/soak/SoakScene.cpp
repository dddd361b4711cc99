// SPDX-License-Identifier: MIT
#include "SoakScene.h"

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int mostClones = 60;
constexpr std::size_t mostInstances = 200;

std::size_t below(std::size_t end, std::mt19937& random)
{
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

} // namespace

SoakScene::SoakScene(osg::ref_ptr<osg::Node> model, std::size_t fieldCount, std::mt19937& random)
    : _model(model), _root(new osg::Group), _clones(new osg::Group), _crowd(new AnimatedCrowd(*findCharacter(*model))),
      _field(new AnimatedCrowd(*findCharacter(*model)))
{
    for (osg::Node* child : std::initializer_list<osg::Node*>{_clones, _crowd, _field})
        _root->addChild(child);
    const double density = std::max(1.0, static_cast<double>(fieldCount) / mostInstances);
    _reach = 15.0 * _model->getBound().radius() * std::sqrt(density);
    static_cast<void>(_field->getMeshes().setPixelError(0.5f)); // in range
    while (_fieldInstances.size() < fieldCount)
        _fieldInstances.push_back(addTo(*_field, random));
}

osg::Matrixd SoakScene::randomPlace(std::mt19937& random) const
{
    std::uniform_real_distribution<double> along(-_reach, _reach);
    const double x = along(random);
    return osg::Matrixd::translate(x, along(random), 0.0);
}

void SoakScene::cloneOne(std::mt19937& random)
{
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(randomPlace(random));
    place->addChild(osg::clone(_model.get(), osg::CopyOp::DEEP_COPY_NODES));
    _clones->addChild(place);
}

void SoakScene::removeOne(std::mt19937& random)
{
    if (_clones->getNumChildren() == 0) return;
    _clones->removeChild(static_cast<unsigned int>(below(_clones->getNumChildren(), random)));
}

void SoakScene::changeClip(AnimationController& controller, std::mt19937& random)
{
    const std::size_t clips = controller.set().clips().size();
    if (clips == 0) return;
    const std::string name = controller.set().clips()[below(clips, random)].name();
    const bool fades = below(2, random) == 0;
    const auto changed = fades ? controller.crossfade(name, 0.3) : controller.play(name);
    (void)changed; // the clip is there
    controller.setSpeed(0.5 + 0.25 * static_cast<double>(below(6, random)));
}

void SoakScene::changeCrowd(std::mt19937& random)
{
    if (!_instances.empty() && (below(3, random) == 0 || _instances.size() >= mostInstances))
    {
        const std::size_t index = below(_instances.size(), random);
        _crowd->remove(_instances[index]);
        _instances[index] = _instances.back();
        _instances.pop_back();
        return;
    }
    _instances.push_back(addTo(*_crowd, random));
}

AnimatedCrowd::Instance SoakScene::addTo(AnimatedCrowd& crowd, std::mt19937& random)
{
    AnimationController controller(crowd.getSharedAnimationSet());
    changeClip(controller, random);
    return crowd.add(randomPlace(random), controller).value(); // the place is finite, the set the crowd's
}

void SoakScene::changeField(std::mt19937& random)
{
    const auto some = [&]() -> AnimatedCrowd::Instance&
    { return _fieldInstances[below(_fieldInstances.size(), random)]; };
    for (std::size_t change = 0; change < _fieldInstances.size() / 100; ++change)
    {
        AnimatedCrowd::Instance& replaced = some();
        _field->remove(replaced);
        replaced = addTo(*_field, random);
        const AnimatedCrowd::Instance moved = some();
        static_cast<void>(_field->setPlacement(moved, randomPlace(random))); // it is there
        changeClip(*_field->getController(some()), random);
    }
}

void SoakScene::clear()
{
    _clones->removeChildren(0, _clones->getNumChildren());
    for (const AnimatedCrowd::Instance instance : _instances)
        _crowd->remove(instance);
    _instances.clear();
}

void SoakScene::change(std::mt19937& random)
{
    const bool isFull = _clones->getNumChildren() >= mostClones;
    if (below(2, random) == 0 && !isFull)
        cloneOne(random);
    else
        removeOne(random);
    changeCrowd(random);
    changeField(random);
    if (_clones->getNumChildren() > 0)
    {
        osg::Node& node = *_clones->getChild(static_cast<unsigned int>(below(_clones->getNumChildren(), random)));
        changeClip(findCharacter(node)->getController(), random);
    }
    if (!_instances.empty())
        if (AnimationController* controller = _crowd->getController(_instances[below(_instances.size(), random)]))
            changeClip(*controller, random);
}

} // namespace osgGpuAnimation
