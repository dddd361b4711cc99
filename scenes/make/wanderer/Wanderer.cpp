// SPDX-License-Identifier: MIT
#include "Wanderer.h"
#include "../PngEncoder.h"
#include "../RigNodes.h"
#include "WandererBody.h"
#include "WandererGear.h"
#include "WandererHead.h"
#include "WandererLantern.h"
#include "WandererMotions.h"
#include "WandererRig.h"

namespace osgGpuAnimation::scenes
{

namespace
{

int addBody(GltfDocument& document, const Rig& rig)
{
    CharacterMesh parts(rig);
    addWandererHead(parts);
    addWandererBody(parts);
    addWandererGear(parts);
    parts.finish();

    tinygltf::Material material;
    material.name = "Wanderer";
    material.pbrMetallicRoughness.baseColorTexture.index =
        document.addTexture("Wanderer", encodePng(parts.atlas().pixels(), Atlas::size, Atlas::size));
    const int reflections = Atlas::reflectionSize;
    material.pbrMetallicRoughness.metallicRoughnessTexture.index =
        document.addTexture("WandererReflections", encodePng(parts.atlas().reflections(), reflections, reflections));
    const int mesh = document.addMesh("Wanderer");
    document.addPrimitive(mesh, parts.arrays(), document.addMaterial(material));
    return mesh;
}

} // namespace

void writeWanderer(const std::string& path)
{
    const Rig rig = makeWandererRig();
    GltfDocument document("Wanderer");
    const int root = document.addNode("Armature", -1);
    const std::vector<int> nodes = addRigNodes(document, rig, root);

    const int body = document.addNode("Body", -1); // the joints alone place a skinned mesh (glTF 2.0, 3.7.3.3)
    document.node(body).mesh = addBody(document, rig);
    document.node(body).skin = addRigSkin(document, "Wanderer", rig, nodes);
    document.node(nodes[rig.index("Lantern")]).mesh = addWandererLantern(document);

    for (const Motion& motion : {wandererIdle(), wandererWalk(), wandererRun(), wandererWave()})
        addClip(document, rig, nodes, motion);
    document.write(path);
}

} // namespace osgGpuAnimation::scenes
