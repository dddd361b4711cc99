// SPDX-License-Identifier: MIT
#include "gltf/NodeRules.h"

#include "gltf/ElementName.h"

#include <cmath>
#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

namespace
{

// Beyond what rounding to a few digits leaves; the Khronos validator draws the line here too.
const double unitTolerance = 0.00769;

void leaveOut(const JsonValue& node, std::string_view member, const std::string& name, const char* why, Report& report)
{
    const JsonValue value = node[member];
    if (!value) return;
    value.dropFrom(node);
    report.warn(name + '.' + std::string(member) + ": " + why + "; left out");
}

void checkMatrix(const JsonValue& matrix, const std::string& name, Report& report)
{
    static const double lastRow[] = {0.0, 0.0, 0.0, 1.0};
    bool mended = false;
    std::size_t i = 0;
    for (const JsonValue& element : matrix)
    {
        if (i % 4 == 3 && element.number() != lastRow[i / 4])
        {
            element.setNumber(lastRow[i / 4]);
            mended = true;
        }
        ++i;
    }
    if (mended) report.warn(name + ".matrix: its last row is not 0 0 0 1; taken as such");
}

void checkRotation(const JsonValue& node, const std::string& name, Report& report)
{
    const JsonValue rotation = node["rotation"];
    double squares = 0.0;
    for (const JsonValue& element : rotation)
        squares += element.number() * element.number();
    const double length = std::sqrt(squares);
    if (std::abs(length - 1.0) <= unitTolerance) return;
    if (length < 1e-12 || !std::isfinite(length))
        return leaveOut(node, "rotation", name, "expected a unit quaternion, found one without direction", report);
    for (const JsonValue& element : rotation)
        element.setNumber(element.number() / length);
    report.warn(name + ".rotation: expected a unit quaternion, found one of length " + numberText(length) +
                "; made unit");
}

} // namespace

void checkNodeRules(const JsonValue& nodes, Report& report)
{
    std::size_t i = 0;
    for (const JsonValue& node : nodes)
    {
        const std::string name = elementName("nodes", i++);
        if (const JsonValue matrix = node["matrix"])
        {
            for (const std::string_view member : {"translation", "rotation", "scale"})
                leaveOut(node, member, name, "the node has a matrix, which counts", report);
            checkMatrix(matrix, name, report);
        }
        if (node["rotation"]) checkRotation(node, name, report);
        if (!node["mesh"])
            for (const std::string_view member : {"skin", "weights"})
                leaveOut(node, member, name, "the node has no mesh", report);
    }
}

} // namespace osgGpuAnimation::gltf
