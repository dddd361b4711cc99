// SPDX-License-Identifier: MIT
#include "gltf/import/Lights.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/file/Elements.h"

#include <osg/Math>

#include <algorithm>
#include <numeric>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr unsigned int firstNumber = 7; ///< then down to 1: applications begin at 0, the headlight of viewers
constexpr std::size_t maxLights = 7;

PunctualLight::Kind kindOf(const tinygltf::Light& light)
{
    if (light.type == "directional") return PunctualLight::Kind::Directional;
    return light.type == "spot" ? PunctualLight::Kind::Spot : PunctualLight::Kind::Point;
}

/// Error: the product of colour and intensity is beyond float numbers.
Result<osg::ref_ptr<PunctualLight>> makeLight(const tinygltf::Light& light, unsigned int number)
{
    osg::ref_ptr<PunctualLight> made = new PunctualLight(kindOf(light), number);
    const osg::Vec3 color(osg::Vec3d(light.color[0], light.color[1], light.color[2]));
    Result<void> set = made->setIntensity(color, static_cast<float>(light.intensity));
    if (set) set = made->setRange(static_cast<float>(light.range));
    // Rounded to floats, pi / 2 is more than 90 degrees, and two angles may be equal.
    const float outer = std::min(90.0f, static_cast<float>(osg::RadiansToDegrees(light.spot.outerConeAngle)));
    const float inner = static_cast<float>(osg::RadiansToDegrees(light.spot.innerConeAngle));
    if (set && light.type == "spot") set = made->setCone(std::min(inner, outer * 0.9999f), outer);
    if (!set) return set.error();
    return made;
}

osg::ref_ptr<osg::LightSource> makeSource(const tinygltf::Model& model, const ImportedLight& light, PunctualLight& made)
{
    const std::string& name = elementOf(model.lights, light.light).name;
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setName(name.empty() ? elementOf(model.nodes, light.node).name : name);
    made.setName(source->getName());
    source->setLight(&made);
    // The sun is not part of the scene that a viewer frames. The callback itself computes an invalid sphere.
    source->setComputeBoundingSphereCallback(new osg::Node::ComputeBoundingSphereCallback);
    return source;
}

/// The indices of the lights that remain, in their order.
std::vector<std::size_t> nearest(const tinygltf::Model& model, const NodeTree& tree, const osg::Vec3d& middle,
                                 const std::vector<ImportedLight>& lights, Report& report)
{
    std::vector<std::size_t> kept(lights.size());
    std::iota(kept.begin(), kept.end(), std::size_t(0));
    if (lights.size() <= maxLights) return kept;
    std::vector<double> distances;
    for (const ImportedLight& light : lights)
    {
        const glm::dvec4& place = elementOf(tree.toWorld, light.node)[3];
        const bool isEverywhere = kindOf(elementOf(model.lights, light.light)) == PunctualLight::Kind::Directional;
        distances.push_back(isEverywhere ? -1.0 : (osg::Vec3d(place.x, place.y, place.z) - middle).length());
    }
    std::stable_sort(kept.begin(), kept.end(),
                     [&](std::size_t a, std::size_t b) { return distances[a] < distances[b]; });
    kept.resize(maxLights);
    std::sort(kept.begin(), kept.end());
    report.warn("nodes: the scene has " + std::to_string(lights.size()) + " lights, OpenGL has " +
                std::to_string(maxLights) + " beside the viewer's; the nearest to its middle are shown");
    return kept;
}

} // namespace

const char* lightTypeName(PunctualLight::Kind kind)
{
    if (kind == PunctualLight::Kind::Directional) return "directional";
    return kind == PunctualLight::Kind::Spot ? "spot" : "point";
}

std::vector<ImportedLight> findLights(const tinygltf::Model& model, const NodeTree& tree)
{
    std::vector<ImportedLight> lights;
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
    {
        const int light = tree.drawn[node] && !tree.hidden[node] ? lightOf(model.nodes[node]) : -1;
        if (light >= 0 && !elementOf(model.lights, light).type.empty())
            lights.push_back({light, static_cast<int>(node), nullptr});
    }
    return lights;
}

void addLights(const tinygltf::Model& model, const NodeTree& tree, const osg::Vec3d& middle, NodePlaces& places,
               osg::Group& root, std::vector<ImportedLight>& lights, Report& report)
{
    unsigned int number = firstNumber;
    const std::vector<bool> areAnimated = animatedObjects(model, PropertyMember::Object::Light, model.lights.size());
    for (const std::size_t index : nearest(model, tree, middle, lights, report))
    {
        ImportedLight& light = lights[index];
        const auto source = static_cast<std::size_t>(light.light);
        const Result<osg::ref_ptr<PunctualLight>> made = makeLight(model.lights[source], number);
        if (!made)
        {
            report.warn(elementName("extensions.KHR_lights_punctual.lights", source) + ": " + made.error().message +
                        "; the light is left out");
            continue;
        }
        light.source = makeSource(model, light, *made.value());
        if (areAnimated[source]) light.source->setUserValue(lightMark, light.light);
        const std::vector<int> nodes = tree.visibilityWith(elementOf(tree.visibility, light.node));
        if (!nodes.empty()) markVisibility(*light.source, nodes);
        places.add(static_cast<std::size_t>(light.node), light.source);
        root.getOrCreateStateSet()->setMode(GL_LIGHT0 + number, osg::StateAttribute::ON);
        --number;
    }
}

} // namespace osgGpuAnimation::gltf
