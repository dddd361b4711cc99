// SPDX-License-Identifier: MIT
#include "gltf/Import.h"

#include "gltf/data/LoadDocument.h"
#include "gltf/data/MaterialVariants.h"
#include "gltf/file/Elements.h"
#include "gltf/import/ClipFiles.h"
#include "gltf/import/Clips.h"
#include "gltf/import/Drawables.h"
#include "gltf/import/Joints.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/authoring/retarget/JointNames.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/CompactedCharacter.h>
#include <osgGpuAnimation/nodes/detail/StillParts.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <numeric>
#include <random>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t maxPaletteEntries = 65536; // a vertex names entries by 16 bits

/// The index of what the caller asks for: by name, else by the file's number. kind, owner: for the message.
Result<int> choose(const std::string& wanted, const std::string& kind, const std::string& owner,
                   const std::vector<std::string>& names, const std::vector<int>& numbers)
{
    const auto named = std::find(names.begin(), names.end(), wanted);
    if (named != names.end()) return static_cast<int>(named - names.begin());
    const auto numbered = std::find(numbers.begin(), numbers.end(), parsedNumber<int>(wanted).value_or(-1));
    if (numbered != numbers.end()) return static_cast<int>(numbered - numbers.begin());
    return Error{kind + ' ' + quoted(wanted) + " was asked for; the " + owner + "'s " + kind +
                 "s are: " + namesText(names)};
}

/// The index of the variant to show first; -1: none.
Result<int> chooseVariant(const std::vector<std::string>& names, const ImportOptions& options)
{
    if (!options.variant) return -1;
    std::vector<int> numbers(names.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    return choose(*options.variant, "variant", "file", names, numbers);
}

/// A number in [0, 1) that differs from call to call; the n-th of a seed is the same in every process.
double nextRandomShare(std::uint32_t seed)
{
    static std::mutex mutex;
    static std::map<std::uint32_t, std::mt19937> generators;
    const std::lock_guard<std::mutex> lock(mutex);
    return static_cast<double>(generators.try_emplace(seed, seed).first->second()) * 0x1p-32;
}

/// The index in the set of the clip to play first; -1: there is none.
Result<int> chooseClip(const ImportedModel& imported, const ImportOptions& options)
{
    const std::vector<std::string> names = imported.set ? namesIn(imported.set->clips()) : std::vector<std::string>();
    if (options.clip) return choose(*options.clip, "clip", "file", names, imported.animationOfClip);
    return names.empty() ? -1 : 0;
}

Result<int> chooseCamera(const std::vector<ImportedCamera>& cameras, const std::string& wanted)
{
    std::vector<std::string> names;
    std::vector<int> numbers;
    for (const ImportedCamera& camera : cameras)
    {
        names.push_back(camera.view->getName());
        numbers.push_back(camera.camera);
    }
    return choose(wanted, "camera", "scene", names, numbers);
}

/// The steps of one import, with the data and messages that they share.
class Importer
{
public:
    Importer(const tinygltf::Model& model, const std::string& fileName, const ImportOptions& options,
             ImportedModel& result)
        : _model(model), _fileName(osgDB::getStrippedName(fileName)), _options(options), _result(result),
          _report(result.messages), _budget(options.maxDecodedBytes),
          _textures(model, _report, !options.fixedLighting, options.keepEncoded),
          _clipFiles(readClipFiles(fileName, options, _report, &model)),
          _clipJoints(readClipJoints(fileName, options, _report))
    {
    }

    Result<void> run()
    {
        const Result<NodeTree> tree = buildNodeTree(_model, _options);
        if (!tree) return tree.error();
        std::vector<bool> moved = nodesMovedBy(_clipFiles, _clipJoints, _model);
        addNodesOfProperties(_model, tree.value(), moved);
        if (_options.wholeModel) addStillNodes(_model, tree.value(), moved);
        const Result<Joints> joints = buildJoints(_model, tree.value(), moved);
        if (!joints) return joints.error();
        const Morphs morphs = readMorphs(_model);
        if (const Result<void> made = makeSet(tree.value(), joints.value(), morphs); !made) return made;
        _result.variantNames = variantNames(_model);
        const Result<int> variant = chooseVariant(_result.variantNames, _options);
        if (!variant) return variant.error();
        const Result<int> clip = chooseClip(_result, _options);
        if (!clip) return clip.error();
        makeGraph(tree.value(), joints.value(), morphs, variant.value());
        if (const Result<void> started = chooseStart(); !started) return started;
        if (const Result<void> finished = finishClips(); !finished) return finished;
        describeFile(tree.value());
        return play(clip.value());
    }

private:
    Result<void> makeSet(const NodeTree& tree, const Joints& joints, const Morphs& morphs)
    {
        if (joints.skeleton.jointCount() == 0)
        {
            for (const ClipFile& file : _clipFiles)
                _report.unmet(file.name + ": the model has no joints", leftOutText);
            return {};
        }
        Clips clips = readClips(_model, joints, morphs, _fileName, _budget, _report);
        _result.animationOfClip = std::move(clips.animationOfClip);
        Result<std::shared_ptr<const AnimationSet>> set =
            AnimationSet::create({joints.skeleton, readSkins(_model, joints), rigidJoints(_model, tree, joints),
                                  morphs.weights, std::move(clips.clips)});
        if (!set) return set.error();
        for (std::size_t skin = 0; skin < set.value()->skins().size(); ++skin)
            for (const AffineMatrix& matrix : set.value()->skins()[skin].inverseBinds)
                if (!TransformBound::of(matrix.toColumns()).fits())
                    return Error{elementName("skins", skin) + ".inverseBindMatrices: one takes its joint " +
                                 outOfRangeText()};
        if (set.value()->paletteSize() > maxPaletteEntries)
            return Error{"skins and joints: " + std::to_string(set.value()->paletteSize()) +
                         " palette entries are needed, at most " + std::to_string(maxPaletteEntries) + " are possible"};
        _result.set = set.value();
        addClipFiles();
        return {};
    }

    void addClipFiles()
    {
        int animation = static_cast<int>(_model.animations.size());
        for (const ClipFile& file : _clipFiles)
        {
            const auto set = withClipsOf(_result.set, file, _clipJoints, _options.clipMatch, _budget, _report);
            if (set)
                _result.set = set.value();
            else
                _report.unmet(set.error().message, leftOutText);
        }
        warnOfUnknownJoints(_clipJoints, _result.set->skeleton(), _clipFiles, _report);
        while (_result.animationOfClip.size() < _result.set->clips().size())
            _result.animationOfClip.push_back(animation++);
    }

    void makeGraph(const NodeTree& tree, const Joints& joints, const Morphs& morphs, int variant)
    {
        // glTF is +Y up, OSG is +Z up. No other code of the import converts between them. The numbers are exact: the
        // sine and cosine of a rotation by pi / 2 are not.
        const std::string sceneName = tree.scene >= 0 ? elementOf(_model.scenes, tree.scene).name : std::string();
        if (!_options.noRotation) _result.fileToNode.set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
        osg::ref_ptr<osg::MatrixTransform> still = new osg::MatrixTransform(_result.fileToNode);
        still->addCullCallback(new ViewLightsCallback);
        _result.root = still;
        if (_result.set)
        {
            _result.character = new AnimatedCharacter(_result.set);
            static_cast<void>(_result.character->setFileToNode(_result.fileToNode));
            _result.character->setName(_fileName.empty() ? sceneName : _fileName);
            _result.root = new osg::Group;
            _result.root->addChild(_result.character);
        }
        _result.root->setName(sceneName);
        Materials materials(_model, _options.fixedLighting, _textures, _report);
        Meshes meshes(_model, materials.maps(), _budget, _report);
        Drawables drawables(_model, tree, _result.set, meshes, materials, variant, _budget, _report);
        if (!_options.noLights) _result.lights = findLights(_model, tree);
        if (!_options.noCameras) _result.cameras = makeCameras(_model, tree);
        const std::vector<bool> carries = nodesThatCarry(joints);
        const SceneParts parts{_model, tree, joints, morphs, carries, drawables, _budget, _report};
        NodePlaces places(_model, tree, joints, _result.character,
                          buildSceneGraph(parts, *still, _result.character, _result.primitives));
        if (_result.character && still->getNumChildren() > 0)
        {
            _result.root->addChild(still);
            if (joints.ofStillMeshes >= 0) StillParts::set(*_result.character, *still, joints.ofStillMeshes);
        }
        for (const ImportedCamera& camera : _result.cameras)
            places.add(static_cast<std::size_t>(camera.node), camera.view);
        if (_result.character && !_result.variantNames.empty())
        {
            setVariantNames(*_result.character, _result.variantNames);
            if (variant >= 0) // the meshes show it already
                static_cast<void>(_result.character->getMeshes().setVariant(elementOf(_result.variantNames, variant)));
        }
        if (_result.lights.empty()) return;
        const osg::Matrixd toFile = osg::Matrixd::inverse(_result.fileToNode);
        addLights(_model, tree, _result.root->getBound().center() * toFile, places, *_result.root, _result.lights,
                  _report);
    }

    /// By node: it stands still and has a light or a camera.
    std::vector<bool> nodesThatCarry(const Joints& joints) const
    {
        std::vector<bool> carries(_model.nodes.size(), false);
        const auto add = [&](int node) { elementOf(carries, node) = !elementOf(joints.moves, node); };
        for (const ImportedLight& light : _result.lights)
            add(light.node);
        for (const ImportedCamera& camera : _result.cameras)
            add(camera.node);
        return carries;
    }

    Result<void> chooseStart()
    {
        if (!_options.camera) return {};
        const Result<int> chosen = chooseCamera(_result.cameras, *_options.camera);
        if (!chosen) return chosen.error();
        _result.startCamera = elementOf(_result.cameras, chosen.value()).view;
        _result.root->addEventCallback(new StartView(_result.startCamera->getName()));
        return {};
    }

    /// Needs the meshes: they bound the effect of a joint's error, and some have levels of detail.
    Result<void> finishClips()
    {
        if (!_result.character) return {};
        if (_options.compact && !_result.set->clips().empty())
        {
            Result<CompactedCharacter> compacted = compactClipsOf(*_result.character, *_options.compact);
            if (!compacted) return compacted.error();
            _result.compacted = std::move(compacted).value();
            _result.set = _result.character->getController().sharedSet();
        }
        _result.character->computeClipBounds();
        return _result.character->getMeshes().setPixelError(static_cast<float>(_options.pixelError));
    }

    void describeFile(const NodeTree& tree)
    {
        _result.scene = tree.scene;
        _result.nodeParents = tree.parents;
        _result.nodeNames = namesIn(_model.nodes);
        _result.materials = describeMaterials(_model);
        _result.extensionsUsed = _model.extensionsUsed;
        _result.generator = _model.asset.generator;
    }

    Result<void> play(int clip)
    {
        if (!_result.character) return {};
        if (!_options.noKeys) _result.character->addEventCallback(new CharacterKeys(_options.fadeSeconds));
        AnimationController& controller = _result.character->getController();
        controller.setSpeed(_options.speed);
        controller.setLoopMode(_options.loopMode);
        if (clip < 0) return {};
        const Result<void> playing = controller.play(static_cast<std::size_t>(clip));
        if (playing && _options.start)
            controller.seek(*_options.start);
        else if (playing && _options.randomStart)
            controller.seek(nextRandomShare(*_options.randomStart) * controller.duration());
        return playing;
    }

    const tinygltf::Model& _model;
    const std::string _fileName; ///< without folder and extension
    const ImportOptions& _options;
    ImportedModel& _result;
    Report _report;
    MemoryBudget _budget;
    Textures _textures; ///< starts decoding in its constructor
    const std::vector<ClipFile> _clipFiles;
    const ClipJoints _clipJoints; ///< of those files
};

} // namespace

Result<ImportedModel> importModel(const std::string& bytes, const std::string& fileName, const ImportOptions& options,
                                  Messages* outOfFailure)
{
    ImportedModel result;
    const Result<tinygltf::Model> model = loadDocument(bytes, fileName, options, result.messages);
    const Result<void> imported =
        model ? Importer(model.value(), fileName, options, result).run() : Result<void>(model.error());
    if (imported) return result;
    if (outOfFailure) *outOfFailure = std::move(result.messages);
    return imported.error();
}

} // namespace osgGpuAnimation::gltf
