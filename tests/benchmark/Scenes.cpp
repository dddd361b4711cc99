// SPDX-License-Identifier: MIT
#include "Scenes.h"

#include "PoseCrowd.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/Notify>
#include <osgUtil/UpdateVisitor>

#include <cmath>
#include <map>
#include <random>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// The placement of a character in a square grid, row by row.
osg::Matrixd placement(const Subject& subject, std::size_t number, std::size_t count)
{
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    const double spacing = 1.5 * subject.model.root->getBound().radius();
    return osg::Matrixd::translate(spacing * static_cast<double>(number % columns),
                                   spacing * static_cast<double>(number / columns), 0.0);
}

/// The distance of neighbours on a field, in the units of the subject's file.
double spacingOf(const Subject& subject)
{
    const std::map<std::string, double> known{{"Fox", 110.0}, {"CesiumMan", 1.1}, {"Knight", 2.2}, {"Wanderer", 1.1}};
    const auto bar = known.find(subject.name);
    return bar == known.end() ? 1.3 * subject.model.root->getBound().radius() : bar->second;
}

double durationOf(const Subject& subject)
{
    return subject.set().clips()[subject.clip].duration();
}

} // namespace

CharacterScene::CharacterScene(const Subject& subject, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> character =
            osg::clone(subject.model.character.get(), osg::CopyOp::DEEP_COPY_NODES);
        character->setMatrix(placement(subject, i, count));
        static_cast<void>(character->getController().play(subject.clip));
        character->getController().seek(phaseOf(i, durationOf(subject)));
        root->addChild(character);
        characters.push_back(character);
    }
}

std::vector<std::set<std::string>> hiddenParts(const Subject& subject)
{
    std::set<std::string> parts;
    forEachMesh(*subject.model.character, [&](const SkinnedGeometry& mesh) { parts.insert(mesh.getName()); });
    if (parts.size() < 4) return {};
    std::mt19937 random(7);
    std::vector<std::set<std::string>> hidden(outfitCount);
    for (std::set<std::string>& ofOutfit : hidden)
        for (const std::string& part : parts)
            if (random() % 3 == 0) ofOutfit.insert(part);
    return hidden;
}

void CharacterScene::pause()
{
    for (const osg::ref_ptr<AnimatedCharacter>& character : characters)
        character->getController().pause();
}

void CharacterScene::setPixelError(float pixels)
{
    for (const osg::ref_ptr<AnimatedCharacter>& character : characters)
    {
        taken(character->getMeshes().setPixelError(pixels));
        character->getMeshes().waitForLevels();
    }
}

void CharacterScene::check(osg::State& state) const
{
    PosePipeline* pipeline = PosePipeline::of(state);
    if (!pipeline) throw std::runtime_error("there is no pose pipeline");
    for (const std::size_t i : {std::size_t(0), characters.size() / 2, characters.size() - 1})
    {
        // All characters are visible, so their indices in the frame's batch are those of the nodes.
        const AnimationController& controller = characters[i]->getController();
        requireEqual(controller.set(), controller.instruction(), pipeline->readPalette(state, controller.set(), 0, i),
                     toAffine(characters[i]->getFileToNode()));
    }
}

osg::ref_ptr<AnimatedCrowd> makeCrowd(const Subject& subject, std::size_t count)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*subject.model.character);
    for (std::size_t i = 0; i < count; ++i)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        static_cast<void>(controller.play(subject.clip));
        controller.seek(phaseOf(i, durationOf(subject)));
        taken(crowd->add(placement(subject, i, count), controller));
    }
    return crowd;
}

ReferenceScene::ReferenceScene(const Subject& subject, const ReferenceKit& kit, ReferenceMode mode, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        characters.push_back(kit.make(mode, phaseOf(i, durationOf(subject))));
        characters.back().skeleton->setMatrix(subject.model.fileToNode * placement(subject, i, count));
        root->addChild(characters.back().skeleton);
    }
    // The first update links and sets up; hardware mode warns about each character that shares its program.
    const osg::NotifySeverity level = osg::getNotifyLevel();
    osg::setNotifyLevel(osg::FATAL);
    update(0.0);
    osg::setNotifyLevel(level);
}

void ReferenceScene::update(double time)
{
    osgUtil::UpdateVisitor visitor;
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    stamp->setReferenceTime(time);
    visitor.setFrameStamp(stamp);
    root->accept(visitor);
}

void ReferenceScene::check(const Subject& subject, double time)
{
    update(time);
    for (const std::size_t i : {std::size_t(0), characters.size() / 2, characters.size() - 1})
    {
        AnimationController controller(subject.model.set);
        static_cast<void>(controller.play(subject.clip));
        controller.seek(std::fmod(phaseOf(i, durationOf(subject)) + time, durationOf(subject)));
        controller.advance(0.0);
        std::vector<AffineMatrix> palette;
        Pose::evaluate(subject.set(), controller.instruction(), AffineMatrix(), palette);
        // osgAnimation computes some times in float, and its quaternions round differently.
        if (const double largest = largestDifference(characters[i], palette); !(largest < 1e-3))
            throw std::runtime_error("osgAnimation's character " + std::to_string(i) + " differs by " +
                                     std::to_string(largest) + " of its size");
    }
}

osg::ref_ptr<osg::Group> makeUnskinnedScene(const Subject& subject, std::size_t count, Shading shading)
{
    osg::ref_ptr<osg::Group> meshes = new osg::Group;
    for (const gltf::ImportedPrimitive& primitive : subject.model.primitives)
        if (const auto* mesh = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get()))
            meshes->addChild(unskinned(*mesh, shading));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    for (std::size_t i = 0; i < count; ++i)
    {
        osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(subject.model.fileToNode * placement(subject, i, count));
        for (unsigned int mesh = 0; mesh < meshes->getNumChildren(); ++mesh)
            place->addChild(meshes->getChild(mesh));
        root->addChild(place);
    }
    return root;
}

Field::Field(const Subject& subject, std::size_t step, std::size_t first)
    : _spacing(spacingOf(subject)), _crowd(new AnimatedCrowd(*subject.model.character))
{
    std::mt19937 random(1);
    for (std::size_t place = first; place < places; place += step)
    {
        AnimationController controller(_crowd->getSharedAnimationSet());
        static_cast<void>(controller.play(random() % subject.set().clips().size()));
        controller.seek(phaseOf(place, controller.duration()));
        const double x = _spacing * static_cast<double>(place % columns);
        const double y = _spacing * static_cast<double>(place / columns);
        _members.push_back({place, taken(_crowd->add(osg::Matrixd::translate(x, y, 0.0), controller))});
    }
}

void Field::walk(double way)
{
    const osg::Matrixd small = osg::Matrixd::scale(osg::Vec3d(1, 1, 1) / _spacing);
    for (const auto& [place, instance] : _members)
    {
        const double x = static_cast<double>(place % columns), y = static_cast<double>(place / columns);
        taken(_crowd->setPlacement(instance, small * osg::Matrixd::translate(x, y + way, 0.0)));
    }
}

void lookAcross(StagedViewer& viewer, const osg::BoundingSphere& field)
{
    const osg::Vec3d centre = field.center();
    viewer.lookFrom(centre + osg::Vec3d(0.0, -0.74, 0.06) * field.radius(), centre, 30.0);
}

} // namespace osgGpuAnimation::benchmark
