// SPDX-License-Identifier: MIT
#include "Serpent.h"
#include "../RigNodes.h"
#include "SerpentBody.h"
#include "SerpentMotions.h"
#include "SerpentRig.h"

namespace osgGpuAnimation::scenes
{

void writeSerpent(const std::string& path)
{
    const Rig rig = makeSerpentRig();
    GltfDocument document("Serpent");
    const std::vector<int> nodes = addRigNodes(document, rig, document.addNode("Armature", -1));

    tinygltf::Material material;
    material.name = "Scales";
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    material.pbrMetallicRoughness.roughnessFactor = 0.42;
    material.extensions["KHR_materials_clearcoat"] = tinygltf::Value(tinygltf::Value::Object{
        {"clearcoatFactor", tinygltf::Value(1.0)}, {"clearcoatRoughnessFactor", tinygltf::Value(0.12)}}); // water
    const int mesh = document.addMesh("Serpent");
    document.addPrimitive(mesh, serpentArrays(rig), document.addMaterial(material));

    const int body = document.addNode("Body", -1); // the joints alone place a skinned mesh (glTF 2.0, 3.7.3.3)
    document.node(body).mesh = mesh;
    document.node(body).skin = addRigSkin(document, "Serpent", rig, nodes);
    for (const Motion& motion : {serpentSwim(), serpentGlide()})
        addClip(document, rig, nodes, motion);
    document.write(path);
}

} // namespace osgGpuAnimation::scenes
