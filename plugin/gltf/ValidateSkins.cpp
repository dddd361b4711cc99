// SPDX-License-Identifier: MIT
#include "gltf/ValidateSkins.h"

#include "gltf/data/Accessor.h"
#include "gltf/ElementName.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;

std::optional<Error> validateJoints(const Model& model, std::vector<std::size_t>& skinOfNode, std::size_t s)
{
    const std::vector<int>& joints = model.skins[s].joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        std::size_t& last = skinOfNode[std::size_t(joints[j])];
        if (last == s)
            return fault(elementName("skins", s, "joints", j), "each node once",
                         elementName("nodes", std::size_t(joints[j])) + " again");
        last = s;
    }
    return std::nullopt;
}

std::optional<Error> validateInverseBinds(const Model& model, std::size_t s)
{
    const tinygltf::Skin& skin = model.skins[s];
    if (skin.inverseBindMatrices < 0) return std::nullopt;
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(skin.inverseBindMatrices)];
    const std::string name = elementName("skins", s) + ".inverseBindMatrices";
    const std::string accessorName = elementName("accessors", std::size_t(skin.inverseBindMatrices));
    if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        return fault(name, "matrices of type MAT4 of floats", accessorName + ", which has others");
    if (accessor.count < skin.joints.size())
        return fault(name, std::to_string(skin.joints.size()) + " matrices (one a joint)",
                     std::to_string(accessor.count) + " in " + accessorName);
    return std::nullopt;
}

void warnOfLastRows(const Model& model, std::size_t s, Report& report)
{
    const std::vector<float> matrices = readFloats(model, model.skins[s].inverseBindMatrices);
    const float lastRow[] = {0.0f, 0.0f, 0.0f, 1.0f};
    for (std::size_t i = 0; i < matrices.size(); i += 16)
        for (std::size_t column = 0; column < 4; ++column)
            if (std::abs(matrices[i + column * 4 + 3] - lastRow[column]) > 1e-6f)
                return report.warn(elementName("skins", s) + ".inverseBindMatrices: the last row of matrix " +
                                   std::to_string(i / 16) + " is not 0 0 0 1; taken as such");
}

/// Which trees the scene to show holds: one flag a root node; all where there is no scene.
std::vector<bool> shownRoots(const Model& model)
{
    std::vector<bool> shown(model.nodes.size(), model.scenes.empty());
    if (model.scenes.empty()) return shown;
    for (int node : model.scenes[std::size_t(std::max(model.defaultScene, 0))].nodes)
        shown[std::size_t(node)] = true;
    return shown;
}

void warnOfPlaces(const Model& model, const NodeForest& forest, Report& report)
{
    const std::vector<bool> shown = shownRoots(model);
    std::vector<bool> allShown(model.skins.size());
    for (std::size_t s = 0; s < model.skins.size(); ++s)
    {
        const std::vector<int>& joints = model.skins[s].joints;
        const auto root = [&](int joint) { return forest.roots()[std::size_t(joint)]; };
        allShown[s] =
            std::all_of(joints.begin(), joints.end(), [&](int joint) { return shown[std::size_t(root(joint))]; });
        if (std::any_of(joints.begin(), joints.end(), [&](int joint) { return root(joint) != root(joints[0]); }))
            report.warn(elementName("skins", s) + ".joints: expected joints of one tree, found several roots");
    }
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
    {
        const int skin = model.nodes[n].skin;
        if (skin >= 0 && shown[std::size_t(forest.roots()[n])] && !allShown[std::size_t(skin)])
            report.warn(elementName("nodes", n) + ".skin: expected joints in the scene of the mesh, found that " +
                        elementName("skins", std::size_t(skin)) + " has some outside");
    }
}

} // namespace

std::optional<Error> validateSkins(const Model& model, const NodeForest& forest, Report& report)
{
    std::vector<std::size_t> skinOfNode(model.nodes.size(), std::size_t(-1));
    std::vector<bool> seen(model.accessors.size());
    for (std::size_t s = 0; s < model.skins.size(); ++s)
    {
        std::optional<Error> error = validateJoints(model, skinOfNode, s);
        if (!error) error = validateInverseBinds(model, s);
        if (error) return error;
        const int matrices = model.skins[s].inverseBindMatrices;
        if (matrices < 0 || seen[std::size_t(matrices)]) continue;
        seen[std::size_t(matrices)] = true;
        warnOfLastRows(model, s, report);
    }
    warnOfPlaces(model, forest, report);
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
