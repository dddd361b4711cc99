// SPDX-License-Identifier: MIT
#include "Serpent.h"
#include "../RigNodes.h"
#include "SerpentBody.h"
#include "SerpentMotions.h"
#include "SerpentRig.h"
#include "SerpentScales.h"

namespace osgGpuAnimation::scenes
{

namespace
{

/// Coated with water, which lies over the scales. normals: -1: without a normal map.
tinygltf::Material wet(const std::string& name, int normals)
{
    tinygltf::Material material;
    material.name = name;
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    material.pbrMetallicRoughness.roughnessFactor = 0.42;
    tinygltf::Value::Object coat{{"clearcoatFactor", tinygltf::Value(1.0)},
                                 {"clearcoatRoughnessFactor", tinygltf::Value(0.12)}};
    material.normalTexture.index = normals;
    if (normals >= 0)
        coat["clearcoatNormalTexture"] = tinygltf::Value(tinygltf::Value::Object{{"index", tinygltf::Value(normals)}});
    material.extensions["KHR_materials_clearcoat"] = tinygltf::Value(coat);
    return material;
}

} // namespace

void writeSerpent(const std::string& path)
{
    const Rig rig = makeSerpentRig();
    GltfDocument document("Serpent");
    const std::vector<int> nodes = addRigNodes(document, rig, document.addNode("Armature", -1));

    const int mesh = document.addMesh("Serpent");
    const SerpentArrays arrays = serpentArrays(rig);
    const int normals = document.addTexture("Scales", scaleNormals(), true);
    document.addPrimitive(mesh, arrays.scales, document.addMaterial(wet("Scales", normals)));
    document.addPrimitive(mesh, arrays.smooth, document.addMaterial(wet("Skin", -1)));

    const int body = document.addNode("Body", -1); // the joints alone place a skinned mesh (glTF 2.0, 3.7.3.3)
    document.node(body).mesh = mesh;
    document.node(body).skin = addRigSkin(document, "Serpent", rig, nodes);
    for (const Motion& motion : {serpentSwim(), serpentGlide()})
        addClip(document, rig, nodes, motion);
    document.write(path);
}

} // namespace osgGpuAnimation::scenes
