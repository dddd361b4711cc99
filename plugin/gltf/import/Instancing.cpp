// SPDX-License-Identifier: MIT
#include "gltf/import/Instancing.h"

#include "gltf/data/Accessor.h"
#include "gltf/file/Elements.h"

#include <algorithm>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

const char* const extensionName = "EXT_mesh_gpu_instancing";

/// One attribute's numbers; empty if it is absent.
struct Attribute
{
    std::vector<double> numbers;
    std::size_t count = 0;
    std::string fault;
};

Attribute readAttribute(const tinygltf::Model& model, const tinygltf::Value& attributes, const char* name,
                        std::size_t components)
{
    Attribute result;
    if (!attributes.Has(name)) return result;
    const int index = attributes.Get(name).GetNumberAsInt(); // the schema has checked it
    const tinygltf::Accessor& accessor = elementOf(model.accessors, index);
    if (componentCount(accessor) != components)
    {
        result.fault = std::string(name) + ": " + elementName("accessors", index) + " has " +
                       std::to_string(componentCount(accessor)) + " numbers an element, not " +
                       std::to_string(components);
        return result;
    }
    result.count = accessor.count;
    result.numbers = readDoubles(model, index);
    return result;
}

/// The fault of the three together; empty if there is none.
std::string faultOf(const Attribute& translation, const Attribute& rotation, const Attribute& scale)
{
    std::size_t count = 0;
    for (const Attribute* attribute : {&translation, &rotation, &scale})
    {
        if (!attribute->fault.empty()) return attribute->fault;
        if (attribute->numbers.empty()) continue;
        if (count != 0 && attribute->count != count) return "its attributes differ in count";
        count = attribute->count;
    }
    return count == 0 ? "no TRANSLATION, ROTATION or SCALE" : "";
}

osg::Matrixd instance(const Attribute& translation, const Attribute& rotation, const Attribute& scale, std::size_t i)
{
    osg::Matrixd matrix;
    if (!scale.numbers.empty())
        matrix.makeScale(scale.numbers[3 * i], scale.numbers[3 * i + 1], scale.numbers[3 * i + 2]);
    if (!rotation.numbers.empty())
    {
        const double* q = rotation.numbers.data() + 4 * i;
        osg::Quat quaternion(q[0], q[1], q[2], q[3]);
        const double length = quaternion.length();
        if (length > 0.0) matrix.postMultRotate(quaternion / length);
    }
    if (!translation.numbers.empty())
        matrix.postMultTranslate(
            osg::Vec3d(translation.numbers[3 * i], translation.numbers[3 * i + 1], translation.numbers[3 * i + 2]));
    return matrix;
}

} // namespace

bool isInstanced(const tinygltf::Node& node)
{
    return node.extensions.count(extensionName) > 0;
}

std::vector<osg::Matrixd> readInstances(const tinygltf::Model& model, std::size_t node, MemoryBudget& budget,
                                        Report& report)
{
    constexpr std::size_t bytesAnInstance = 1024; // a MatrixTransform as a child
    const std::vector<osg::Matrixd> single(1);
    const std::string label = namedElement("nodes", node, model.nodes[node].name) + ": " + extensionName + ": ";
    const tinygltf::Value& extension = model.nodes[node].extensions.at(extensionName);
    const tinygltf::Value& attributes = extension.Get("attributes");
    const Attribute translation = readAttribute(model, attributes, "TRANSLATION", 3);
    const Attribute rotation = readAttribute(model, attributes, "ROTATION", 4);
    const Attribute scale = readAttribute(model, attributes, "SCALE", 3);
    std::string fault = faultOf(translation, rotation, scale);
    const std::size_t count = std::max({translation.count, rotation.count, scale.count});
    if (fault.empty() && !budget.take(count * bytesAnInstance)) fault = std::to_string(count) + " are too many";
    if (!fault.empty())
    {
        report.warn(label + fault + "; the mesh is drawn once");
        return single;
    }
    std::vector<osg::Matrixd> instances;
    instances.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        instances.push_back(instance(translation, rotation, scale, i));
    return instances;
}

} // namespace osgGpuAnimation::gltf
