// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The begin of an FBX 7.4 file in ASCII, in centimetres. up, front: axes, 0 to 2; frontSign: 1 or -1.
inline std::string fbxHeader(int up, int front, int frontSign)
{
    const auto setting = [](const std::string& name, int value)
    { return "\t\tP: \"" + name + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n"; };
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\n"
           "GlobalSettings:  {\n\tProperties70:  {\n" +
           setting("UpAxis", up) + setting("UpAxisSign", 1) + setting("FrontAxis", front) +
           setting("FrontAxisSign", frontSign) + setting("CoordAxis", 0) + setting("CoordAxisSign", 1) +
           "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n\t}\n}\n";
}

/// An FBX 7.4 file in ASCII, object by object; centimetres, +Y up. Boxes have edges of 100 units around their origin.
///
///     SmallFbx file;
///     file.model(1, "door", R"(P: "Lcl Translation", "Lcl Translation", "", "A",100,0,0)").box(2, 1);
///     file.take(10, "Open", 0.0, 1.0).curve(10, 1, "Lcl Rotation", "Y", {{0.0, 0.0}, {1.0, 90.0}});
///     folder.write("door.fbx", file.text());
class SmallFbx
{
public:
    using Keys = std::vector<std::array<double, 2>>; ///< seconds and values

    SmallFbx& model(int id, const std::string& name, const std::string& properties = "", int parent = 0,
                    const std::string& type = "Mesh")
    {
        _objects += "Model: " + std::to_string(id) + ", \"Model::" + name + "\", \"" + type +
                    "\" {\nProperties70:  {\n" + properties + "\n}\n}\n";
        return connect(id, parent);
    }
    SmallFbx& box(int id, int model)
    {
        _objects += "Geometry: " + std::to_string(id) + R"(, "Geometry::", "Mesh" {
Vertices: *24 {
a: -50,-50,-50,50,-50,-50,-50,50,-50,50,50,-50,-50,-50,50,50,-50,50,-50,50,50,50,50,50
}
PolygonVertexIndex: *24 {
a: 0,2,3,-2,4,5,7,-7,0,1,5,-5,2,6,7,-4,0,4,6,-3,1,3,7,-6
}
}
)";
        return connect(id, model);
    }
    /// A skin of one bone that moves the whole box. The bone and the mesh are bound at the origin.
    SmallFbx& skin(int id, int geometry, int bone)
    {
        const std::string identity = "*16 {\na: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1\n}\n";
        _objects += "Deformer: " + std::to_string(id) +
                    ", \"Deformer::\", \"Skin\" {\n}\nDeformer: " + std::to_string(id + 1) +
                    ", \"SubDeformer::\", \"Cluster\" {\nIndexes: *8 {\na: 0,1,2,3,4,5,6,7\n}\nWeights: *8 {\na: "
                    "1,1,1,1,1,1,1,1\n}\nTransform: " +
                    identity + "TransformLink: " + identity + "}\n";
        return connect(id, geometry).connect(id + 1, id).connect(bone, id + 1);
    }
    /// A deformer of a geometry, for shape().
    SmallFbx& deformer(int id, int geometry)
    {
        _objects += "Deformer: " + std::to_string(id) + ", \"Deformer::\", \"BlendShape\" {\n}\n";
        return connect(id, geometry);
    }
    /// A channel; its targets move the vertices 2, 3, 6 and 7 (y is 50) by the given offsets, full at the percentages.
    SmallFbx& shape(int id, int deformer, const std::string& name, double percent,
                    const std::vector<double>& fullPercents, const std::vector<std::string>& offsets)
    {
        _objects += "Deformer: " + std::to_string(id) + ", \"SubDeformer::" + name + "\", \"BlendShapeChannel\" {\n" +
                    "DeformPercent: " + number(percent) + "\nFullWeights: " + array(fullPercents) +
                    "Properties70:  {\n" + R"(P: "DeformPercent", "Number", "", "A",)" + number(percent) + "\n}\n}\n";
        connect(id, deformer);
        for (std::size_t i = 0; i < offsets.size(); ++i)
        {
            const int target = id + 1 + static_cast<int>(i);
            const std::string& by = offsets[i];
            _objects += "Geometry: " + std::to_string(target) + ", \"Geometry::" + name +
                        "\", \"Shape\" {\nIndexes: *4 {\na: 2,3,6,7\n}\nVertices: *12 {\na: " + by + ',' + by + ',' +
                        by + ',' + by + "\n}\nNormals: *12 {\na: 0,0,0,0,0,0,0,0,0,0,0,0\n}\n}\n";
            connect(target, id);
        }
        return *this;
    }
    /// A take with a layer of the number id + 1. Seconds; without: the take has the range of its keys.
    SmallFbx& take(int id, const std::string& name)
    {
        _objects += "AnimationStack: " + std::to_string(id) + ", \"AnimStack::" + name + "\", \"\" {\n}\n";
        return layer(id);
    }
    SmallFbx& take(int id, const std::string& name, double begin, double end)
    {
        _objects += "AnimationStack: " + std::to_string(id) + ", \"AnimStack::" + name +
                    "\", \"\" {\nProperties70:  {\nP: \"LocalStart\", \"KTime\", \"Time\", \"\"," + ticks(begin) +
                    "\nP: \"LocalStop\", \"KTime\", \"Time\", \"\"," + ticks(end) + "\n}\n}\n";
        return layer(id);
    }
    /// Linear keys. component: X, Y, Z or DeformPercent; flags and data: KeyAttrFlags and KeyAttrDataFloat of all keys.
    SmallFbx& curve(int take, int target, const std::string& property, const std::string& component, const Keys& keys,
                    int flags = 4, const std::string& data = "0,0,218434821,0")
    {
        const int node = 100000 + 2 * _curves++, curve = node + 1;
        std::string times, values;
        for (const auto& [seconds, value] : keys)
        {
            times += (times.empty() ? "" : ",") + ticks(seconds);
            values += (values.empty() ? "" : ",") + number(value);
        }
        const std::string count = std::to_string(keys.size());
        _objects += "AnimationCurveNode: " + std::to_string(node) +
                    ", \"AnimCurveNode::\", \"\" {\n}\nAnimationCurve: " + std::to_string(curve) +
                    ", \"AnimCurve::\", \"\" {\nKeyTime: *" + count + " {\na: " + times + "\n}\nKeyValueFloat: *" +
                    count + " {\na: " + values + "\n}\nKeyAttrFlags: *1 {\na: " + std::to_string(flags) +
                    "\n}\nKeyAttrDataFloat: *4 {\na: " + data + "\n}\nKeyAttrRefCount: *1 {\na: " + count + "\n}\n}\n";
        connect(node, take + 1);
        _connections += "C: \"OP\"," + std::to_string(node) + ',' + std::to_string(target) + ", \"" + property + "\"\n";
        _connections +=
            "C: \"OP\"," + std::to_string(curve) + ',' + std::to_string(node) + ", \"d|" + component + "\"\n";
        return *this;
    }
    SmallFbx& constraint(int id, const std::string& name)
    {
        _objects += "Constraint: " + std::to_string(id) + ", \"Constraint::" + name + "\", \"Aim\" {\n}\n";
        return *this;
    }
    SmallFbx& connect(int source, int destination)
    {
        _connections += "C: \"OO\"," + std::to_string(source) + ',' + std::to_string(destination) + "\n";
        return *this;
    }

    std::string text() const
    {
        return fbxHeader(1, 2, 1) + "Objects:  {\n" + _objects + "}\nConnections:  {\n" + _connections + "}\n";
    }

    static std::string vector(const std::string& property, double x, double y, double z)
    {
        return "P: \"" + property + "\", \"Vector3D\", \"Vector\", \"\"," + number(x) + ',' + number(y) + ',' +
               number(z) + '\n';
    }

private:
    static std::string number(double value)
    {
        char text[32];
        std::snprintf(text, sizeof(text), "%.12g", value);
        return text;
    }
    static std::string ticks(double seconds) { return std::to_string(static_cast<long long>(seconds * 46186158000.0)); }
    static std::string array(const std::vector<double>& numbers)
    {
        std::string text = "*" + std::to_string(numbers.size()) + " {\na: ";
        for (std::size_t i = 0; i < numbers.size(); ++i)
            text += (i > 0 ? "," : "") + number(numbers[i]);
        return text + "\n}\n";
    }
    SmallFbx& layer(int take)
    {
        _objects += "AnimationLayer: " + std::to_string(take + 1) + ", \"AnimLayer::BaseLayer\", \"\" {\n}\n";
        return connect(take + 1, take);
    }

    std::string _objects, _connections;
    int _curves = 0;
};

} // namespace osgGpuAnimation
