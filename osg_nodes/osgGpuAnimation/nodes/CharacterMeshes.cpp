// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CharacterMeshes.h>

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/LevelsTask.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>
#include <osgGpuAnimation/nodes/properties/OutfitMeshes.h>

#include <algorithm>

namespace osgGpuAnimation
{

CharacterMeshes::CharacterMeshes(osg::Group& node, const std::shared_ptr<const AnimationSet>& set,
                                 const AnimationController* controller)
    : _node(node), _set(set), _controller(controller), _variantMeshes(std::make_shared<VariantMeshes>()),
      _properties(controller ? AnimatedProperties::of(*set) : nullptr)
{
}

void CharacterMeshes::copySettings(const CharacterMeshes& other)
{
    _variantMeshes = other._variantMeshes;
    _variant = other._variant;
    _pixelError = other._pixelError;
    _levels = other._levels;
    _task = other._task;
    if (other._outfits)
    {
        _outfits = std::make_unique<OutfitMeshes>(*other._outfits);
        _outfits->update(_node);
    }
    if (_properties) _properties->bind(_node); // the children are the other's, too
}

CharacterMeshes::~CharacterMeshes() = default;

void CharacterMeshes::forgetProperties()
{
    _properties = AnimatedProperties::of(*_set);
}

SkinnedGeometry* CharacterMeshes::find(const std::string& name) const
{
    const Result<std::vector<SkinnedGeometry*>> meshes = meshesNamed(_node, name);
    return meshes ? meshes.value().front() : nullptr;
}

/// Calls change() while the meshes have the masks that the application gave them.
template <typename Change>
void CharacterMeshes::change(Change change)
{
    if (_properties) _properties->restoreMasks();
    change();
    if (!_properties || !_properties->isBound()) return;
    _properties->bind(_node);
    showProperties();
}

Result<void> CharacterMeshes::setVisible(const std::string& name, bool isVisible)
{
    if (const auto meshes = meshesNamed(_node, name); !meshes) return meshes.error();
    if (_properties && !_properties->isBound()) _properties->bind(_node);
    change(
        [&]
        {
            const std::vector<SkinnedGeometry*> own = meshesNamed(_node, name).value();
            _variantMeshes->setVisible(_node, {own.begin(), own.end()}, isVisible);
        });
    return {};
}

std::vector<std::string> CharacterMeshes::getVariants() const
{
    return variantNamesIn(_node);
}

Result<void> CharacterMeshes::setVariant(const std::string& name)
{
    const std::vector<std::string> names = getVariants();
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
        return Error{"there is no material variant \"" + name + "\"; the variants are " + quotedNames(names)};
    _variant = name;
    change([&] { _variantMeshes->show(_node, name); });
    return {};
}

void CharacterMeshes::showVariant()
{
    change(
        [&]
        {
            if (!_variant.empty()) _variantMeshes->show(_node, _variant);
        });
}

void CharacterMeshes::showProperties()
{
    if (!_properties) return;
    if (!_properties->isBound()) _properties->bind(_node);
    _properties->apply(*_set, _controller->instruction());
}

const osg::Group& CharacterMeshes::drawn() const
{
    return _outfits ? _outfits->meshes() : _node;
}

void CharacterMeshes::showLevels()
{
    if (_outfits) _outfits->showLevels(_levels && _levels->isOf(drawn(), *_set) ? _levels.get() : nullptr);
}

Result<void> CharacterMeshes::setPixelError(float pixels)
{
    if (!LodRange::isPixelError(pixels))
        return Error{"a pixel error of " + std::to_string(pixels) + ": it must be " + LodRange::describePixelErrors()};
    _pixelError = pixels;
    requestPresentLevels();
    return {};
}

void CharacterMeshes::requestPresentLevels()
{
    if (_levels && !_levels->isOf(drawn(), *_set)) _levels = nullptr;
    requestLevels();
}

bool CharacterMeshes::isMissingLevels() const
{
    if (!(_pixelError > 0.0f) || _set->paletteSize() == 0) return false;
    return (!_controller && !_levels) || LevelsTask::areMissing(drawn());
}

void CharacterMeshes::requestLevels()
{
    const bool isMerged = !_controller && !_levels;
    if (!isMissingLevels())
        _task = nullptr;
    else if (!_task || !_task->isOf(drawn(), *_set, isMerged))
        _task = LevelsTask::of(drawn(), _set, isMerged, _outfits != nullptr);
    if (_task && _task->isDone()) takeLevels(); // of another node
}

void CharacterMeshes::takeLevels()
{
    const std::shared_ptr<const CharacterLevels> merged = _task->take();
    if (!_controller && !_levels && merged && merged->isOf(drawn(), *_set)) _levels = merged;
    _task = nullptr;
    showLevels();
}

void CharacterMeshes::updateLevels()
{
    if (_task && _task->isDone()) takeLevels();
    if (!_task && isMissingLevels()) requestLevels();
}

void CharacterMeshes::waitForLevels()
{
    requestPresentLevels();
    if (!_task) return;
    _task->wait();
    takeLevels();
}

} // namespace osgGpuAnimation
