// SPDX-License-Identifier: MIT
#include "tool/Commands.h"

#include "gltf/file/Elements.h"

#include <osgGpuAnimation/gpu/buffers/AnimationBuffers.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Texture>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <set>
#include <sstream>

namespace osgGpuAnimation::tool
{

namespace
{

using nlohmann::ordered_json;

/// Adds up the arrays, indices and images below a node, shared ones once.
class ByteCounter : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    ByteCounter() : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override
    {
        countTextures(node.getStateSet());
        traverse(node);
    }
    void apply(osg::Drawable& drawable) override
    {
        countTextures(drawable.getStateSet());
        const auto* geometry = dynamic_cast<const osg::Geometry*>(&drawable);
        if (!geometry) return;
        osg::Geometry::ArrayList arrays;
        geometry->getArrayList(arrays);
        for (const osg::ref_ptr<osg::Array>& array : arrays)
            if (_seen.insert(array.get()).second) meshBytes += array->getTotalDataSize();
        for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry->getPrimitiveSetList())
            if (primitives && _seen.insert(primitives.get()).second) meshBytes += primitives->getTotalDataSize();
    }

    std::size_t meshBytes = 0;
    std::size_t textureBytes = 0;

private:
    void countTextures(const osg::StateSet* state)
    {
        for (unsigned int unit = 0; state && unit < state->getNumTextureAttributeLists(); ++unit)
        {
            const auto* texture =
                dynamic_cast<const osg::Texture*>(state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE));
            for (unsigned int face = 0; texture && face < texture->getNumImages(); ++face)
            {
                const osg::Image* image = texture->getImage(face);
                if (image && _seen.insert(image).second) textureBytes += image->getTotalSizeInBytesIncludingMipmaps();
            }
        }
    }

    std::set<const osg::Object*> _seen;
};

/// [[x, y, z], [x, y, z]], or null for an invalid box.
ordered_json reportBox(const osg::BoundingBox& box)
{
    if (!box.valid()) return nullptr;
    return {{box.xMin(), box.yMin(), box.zMin()}, {box.xMax(), box.yMax(), box.zMax()}};
}

/// The rest pose of the character and all that stands still, in the axes of the file.
osg::BoundingBox restBounds(const gltf::ImportedModel& model)
{
    osg::BoundingBox bounds;
    if (model.character) bounds = model.character->getClipBounds(-1);
    for (const gltf::ImportedPrimitive& primitive : model.primitives)
    {
        if (dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get())) continue;
        bounds.expandBy(transformed(primitive.geometry->getBoundingBox(), primitive.toModel));
    }
    return bounds;
}

ordered_json reportJoints(const AnimationSet* set)
{
    ordered_json joints = {
        {"count", 0}, {"depth", 0}, {"roots", ordered_json::array()}, {"list", ordered_json::array()}};
    if (!set) return joints;
    joints["count"] = set->skeleton().jointCount();
    joints["depth"] = set->skeleton().jointCount() > 0 ? set->skeleton().levelCount() : 0;
    for (const Joint& joint : set->skeleton().joints())
    {
        if (joint.parent < 0) joints["roots"].push_back(joint.name);
        joints["list"].push_back({{"name", joint.name}, {"parent", joint.parent}});
    }
    return joints;
}

ordered_json reportSkins(const AnimationSet* set)
{
    ordered_json skins = ordered_json::array();
    for (std::size_t s = 0; set && s < set->skins().size(); ++s)
        skins.push_back({{"name", set->skins()[s].name}, {"joints", set->skins()[s].joints.size()}});
    return skins;
}

ordered_json reportClips(const gltf::ImportedModel& model)
{
    ordered_json clips = ordered_json::array();
    for (std::size_t c = 0; model.set && c < model.set->clips().size(); ++c)
    {
        const Clip& clip = model.set->clips()[c];
        clips.push_back({{"index", model.animationOfClip[c]},
                         {"name", clip.name()},
                         {"seconds", clip.duration()},
                         {"keyframes", clip.keyframeCount()},
                         {"form", clip.form() == Clip::Form::Spline ? "spline" : "linear"},
                         {"bounds", reportBox(model.character->getClipBounds(static_cast<int>(c)))}});
    }
    return clips;
}

/// bytes: on the GPU. snapshotBytes: the size of uncompressed keyframes, 48 bytes per joint.
ordered_json reportKeyframes(const gltf::ImportedModel& model)
{
    if (!model.set) return {{"count", 0}, {"bytes", 0}, {"snapshotBytes", 0}};
    std::size_t count = 0, transforms = 0;
    for (const Clip& clip : model.set->clips())
    {
        count += clip.keyframeCount();
        transforms += clip.data().size();
    }
    ordered_json keyframes = {{"count", count},
                              {"bytes", PackedKeyframes(*model.set).byteSize()},
                              {"snapshotBytes", transforms * sizeof(JointTransform)}};
    if (!model.compacted) return keyframes;
    const CompactedCharacter& compacted = *model.compacted;
    keyframes["error"] =
        compacted.errors.empty() ? 0.0 : *std::max_element(compacted.errors.begin(), compacted.errors.end());
    keyframes["tolerance"] = compacted.tolerance;
    keyframes["longestSide"] = compacted.longestSide;
    return keyframes;
}

ordered_json reportMeshes(const gltf::ImportedModel& model)
{
    std::set<int> meshes;
    std::set<std::string> parts; // of the character
    std::size_t primitives = 0, vertices = 0, skinned = 0, rigid = 0, still = 0, targets = 0;
    for (const gltf::ImportedPrimitive& drawn : model.primitives)
    {
        const std::size_t count = drawn.primitives->size();
        meshes.insert(drawn.mesh);
        primitives += count;
        vertices += count * drawn.vertexCount;
        targets += count * drawn.targets;
        const bool isFromPalette = dynamic_cast<const SkinnedGeometry*>(drawn.geometry.get()) != nullptr;
        (drawn.skin >= 0 ? skinned : (isFromPalette ? rigid : still)) += count;
        if (isFromPalette) parts.insert(drawn.geometry->getName());
    }
    return {{"count", meshes.size()}, {"primitives", primitives}, {"vertices", vertices},    {"skinned", skinned},
            {"rigid", rigid},         {"still", still},           {"morphTargets", targets}, {"parts", parts}};
}

ordered_json reportMaterials(const gltf::ImportedModel& model)
{
    ordered_json materials = ordered_json::array();
    for (const gltf::MaterialDescription& material : model.materials)
    {
        ordered_json report = {{"name", material.name}, {"alphaMode", material.alphaMode}};
        if (material.alphaMode == "MASK") report["alphaCutoff"] = material.alphaCutoff;
        report["doubleSided"] = material.doubleSided;
        report["unlit"] = material.unlit;
        report["maps"] = ordered_json::array();
        for (const gltf::MaterialDescription::Map& map : material.maps)
        {
            ordered_json size = nullptr;
            if (map.width > 0) size = {map.width, map.height};
            report["maps"].push_back({{"map", map.use}, {"image", map.image}, {"size", size}});
        }
        materials.push_back(std::move(report));
    }
    return materials;
}

/// number: OpenGL's, null for a light that is left out.
ordered_json reportLights(const gltf::ImportedModel& model)
{
    ordered_json lights = ordered_json::array();
    for (const gltf::ImportedLight& light : model.lights)
    {
        ordered_json report = {{"index", light.light}, {"node", light.node}, {"number", nullptr}};
        if (light.source)
        {
            const auto& made = dynamic_cast<const PunctualLight&>(*light.source->getLight());
            report["number"] = made.getLightNum();
            report["name"] = made.getName();
            report["type"] = gltf::lightTypeName(made.getKind());
        }
        lights.push_back(std::move(report));
    }
    return lights;
}

ordered_json reportCameras(const gltf::ImportedModel& model)
{
    ordered_json cameras = ordered_json::array();
    for (const gltf::ImportedCamera& camera : model.cameras)
    {
        const bool isPerspective = camera.view->getFieldOfViewMode() == osg::CameraView::VERTICAL;
        cameras.push_back({{"index", camera.camera},
                           {"name", camera.view->getName()},
                           {"node", camera.node},
                           {"type", isPerspective ? "perspective" : "orthographic"}});
    }
    return cameras;
}

std::string line(const std::string& label, const std::string& text)
{
    return label + std::string(17 - label.size(), ' ') + text + "\n";
}

/// For people: three digits are enough.
std::string rounded(const ordered_json& value)
{
    std::ostringstream out;
    out << std::setprecision(3) << value.get<double>();
    return out.str();
}

/// The errors of compact clips.
std::string errorOf(const ordered_json& keyframes)
{
    if (!keyframes.contains("error")) return ", exact";
    const double side = keyframes["longestSide"];
    const double share = side > 0.0 ? keyframes["error"].get<double>() / side : 0.0;
    return "; at most " + rounded(keyframes["error"]) + " off, " + rounded(share) + " of the longest side, which is " +
           rounded(side);
}

std::string nameOr(const ordered_json& name)
{
    return name.get<std::string>().empty() ? "(no name)" : name.get<std::string>();
}

std::string listed(const ordered_json& names)
{
    std::string text;
    for (const ordered_json& name : names)
        text += (text.empty() ? "" : ", ") + nameOr(name);
    return text.empty() ? "none" : text;
}

/// One line a joint, indented below its parent. Joints are stored parents first.
std::string jointLines(const ordered_json& joints)
{
    std::vector<std::vector<std::size_t>> children(joints.size() + 1); // by parent + 1
    for (std::size_t joint = 0; joint < joints.size(); ++joint)
        gltf::elementOf(children, joints[joint]["parent"].get<int>() + 1).push_back(joint);
    std::string text;
    std::vector<std::pair<std::size_t, std::size_t>> open; // joint and depth, the next one last
    const auto add = [&](std::size_t parent, std::size_t depth)
    {
        for (auto child = children[parent].rbegin(); child != children[parent].rend(); ++child)
            open.emplace_back(*child, depth);
    };
    add(0, 1);
    while (!open.empty())
    {
        const auto [joint, depth] = open.back();
        open.pop_back();
        text += std::string(2 * depth, ' ') + nameOr(joints[joint]["name"]) + "\n";
        add(joint + 1, depth + 1);
    }
    return text;
}

/// Coordinates below a thousandth of the greatest one are 0 for people.
std::string boundsText(const ordered_json& bounds)
{
    if (bounds.is_null()) return "none";
    double max = 0.0;
    for (const ordered_json& corner : bounds)
        for (const double coordinate : corner)
            max = std::max(max, std::abs(coordinate));
    std::string text;
    for (const ordered_json& corner : bounds)
    {
        std::string coordinates;
        for (const double coordinate : corner)
            coordinates +=
                (coordinates.empty() ? "" : ", ") + rounded(std::abs(coordinate) < 1e-3 * max ? 0.0 : coordinate);
        text += (text.empty() ? "(" : " to (") + coordinates + ")";
    }
    return text;
}

/// One line a material: how it is drawn, then its maps.
std::string materialLines(const ordered_json& materials)
{
    std::string text;
    for (const ordered_json& material : materials)
    {
        text += "  " + nameOr(material["name"]) + ": ";
        if (material["alphaMode"] == "OPAQUE") text += "opaque";
        if (material["alphaMode"] == "BLEND") text += "blended";
        if (material.contains("alphaCutoff")) text += "masked at " + rounded(material["alphaCutoff"]);
        if (material["doubleSided"]) text += ", double sided";
        if (material["unlit"]) text += ", unlit";
        for (const ordered_json& map : material["maps"])
        {
            const ordered_json& size = map["size"];
            text += "; " + map["map"].get<std::string>() + ' ' +
                    (size.is_null() ? "(no picture)" : size[0].dump() + "x" + size[1].dump());
        }
        text += "\n";
    }
    return text;
}

std::string lightsText(const ordered_json& lights)
{
    std::string text;
    for (const ordered_json& light : lights)
        if (!light["number"].is_null())
            text += (text.empty() ? ": " : ", ") + nameOr(light["name"]) + " (" + light["type"].get<std::string>() +
                    ", GL_LIGHT" + light["number"].dump() + ")";
    const auto isLeftOut = [](const ordered_json& light) { return light["number"].is_null(); };
    const auto leftOut = std::count_if(lights.begin(), lights.end(), isLeftOut);
    return std::to_string(lights.size()) + text + (leftOut == 0 ? "" : "; " + std::to_string(leftOut) + " left out");
}

std::string camerasText(const ordered_json& cameras)
{
    std::string text;
    for (const ordered_json& camera : cameras)
        text += (text.empty() ? ": " : ", ") + nameOr(camera["name"]) + " (" + camera["type"].get<std::string>() + ")";
    return std::to_string(cameras.size()) + text;
}

std::string clipLines(const ordered_json& clips)
{
    std::ostringstream out;
    for (const ordered_json& clip : clips)
    {
        out << "  " << std::right << std::setw(3) << clip["index"].get<int>() << "  " << std::left << std::setw(32)
            << clip["name"].get<std::string>() << std::right << std::fixed << std::setprecision(3) << std::setw(9)
            << clip["seconds"].get<double>() << " s" << std::setw(7) << clip["keyframes"].get<std::size_t>()
            << " keyframes" << (clip["form"] == "spline" ? ", spline" : "") << ", bounds " << boundsText(clip["bounds"])
            << "\n";
    }
    return out.str();
}

ordered_json reportModel(const gltf::ImportedModel& model, const std::string& fileName)
{
    ByteCounter bytes;
    if (model.root) model.root->accept(bytes);
    const std::size_t animationBytes =
        model.set ? AnimationBuffers::byteSize(*model.set, PackedKeyframes(*model.set)) : 0;
    return {{"file", fileName},
            {"generator", model.generator},
            {"scene", model.scene},
            {"joints", reportJoints(model.set.get())},
            {"skins", reportSkins(model.set.get())},
            {"paletteEntries", model.set ? model.set->paletteSize() : 0},
            {"bounds", reportBox(restBounds(model))},
            {"clips", reportClips(model)},
            {"keyframes", reportKeyframes(model)},
            {"meshes", reportMeshes(model)},
            {"materials", reportMaterials(model)},
            {"variants", model.variantNames},
            {"lights", reportLights(model)},
            {"cameras", reportCameras(model)},
            {"extensions", model.extensionsUsed},
            {"gpuBytes",
             {{"animation", animationBytes},
              {"meshes", bytes.meshBytes},
              {"textures", bytes.textureBytes},
              {"total", animationBytes + bytes.meshBytes + bytes.textureBytes}}},
            {"warnings", model.messages.warnings},
            {"notes", model.messages.notes}};
}

std::string reportText(const ordered_json& report)
{
    const ordered_json& joints = report["joints"];
    const ordered_json& meshes = report["meshes"];
    const ordered_json& bytes = report["gpuBytes"];
    std::string skins;
    for (const ordered_json& skin : report["skins"])
        skins += (skins.empty() ? "" : ", ") + nameOr(skin["name"]) + " (" + skin["joints"].dump() + " joints)";

    std::string text = line("file", report["file"].get<std::string>());
    const std::string generator = report["generator"];
    if (!generator.empty()) text += line("generator", generator);
    text += line("joints",
                 joints["count"].dump() + ", " + joints["depth"].dump() + " deep; roots: " + listed(joints["roots"])) +
            jointLines(joints["list"]);
    text += line("skins", std::to_string(report["skins"].size()) + (skins.empty() ? "" : ": " + skins));
    text += line("palette entries", report["paletteEntries"].dump());
    text += line("bounds", boundsText(report["bounds"]) + " in the rest pose");
    text += line("clips", std::to_string(report["clips"].size())) + clipLines(report["clips"]);
    const ordered_json& keyframes = report["keyframes"];
    text += line("keyframes", keyframes["count"].dump() + ", " + keyframes["bytes"].dump() +
                                  " bytes on the GPU (snapshots: " + keyframes["snapshotBytes"].dump() + ")" +
                                  errorOf(keyframes));
    text += line("meshes", meshes["count"].dump() + ", " + meshes["primitives"].dump() + " primitives (" +
                               meshes["skinned"].dump() + " skinned, " + meshes["rigid"].dump() + " rigid on joints, " +
                               meshes["still"].dump() + " still), " + meshes["vertices"].dump() + " vertices, " +
                               meshes["morphTargets"].dump() + " morph targets");
    text += line("parts", listed(meshes["parts"]));
    text += line("materials", std::to_string(report["materials"].size())) + materialLines(report["materials"]);
    text += line("variants", listed(report["variants"]));
    text += line("lights", lightsText(report["lights"]));
    text += line("cameras", camerasText(report["cameras"]));
    text += line("extensions", listed(report["extensions"]));
    text += line("bytes on the GPU", bytes["total"].dump() + " (animation " + bytes["animation"].dump() + ", meshes " +
                                         bytes["meshes"].dump() + ", textures " + bytes["textures"].dump() + ")");
    text += line("warnings", std::to_string(report["warnings"].size()));
    for (const char* kind : {"warnings", "notes"})
        for (const ordered_json& message : report[kind])
            text += "  " + message.get<std::string>() + "\n";
    return text;
}

} // namespace

Result<void> InspectCommand::run() const
{
    const Result<gltf::ImportOptions> given = importOptions(*this);
    if (!given) return given.error();
    gltf::ImportOptions options = given.value();
    options.noRotation = true;
    const Result<gltf::ImportedModel> model = readModel(file, options);
    if (!model) return Error{file + ": " + model.error().message};
    const nlohmann::ordered_json report = reportModel(model.value(), file);
    // Names in a file may hold any bytes; those that are not UTF-8 are replaced.
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    std::cout << (json ? report.dump(2, ' ', false, replace) + "\n" : reportText(report)) << std::flush;
    if (!std::cout) return Error{"standard output: cannot be written"};
    return {};
}

} // namespace osgGpuAnimation::tool
