// SPDX-License-Identifier: MIT
#include "People.h"
#include "../PngEncoder.h"
#include "../RigNodes.h"
#include "../wanderer/WandererBody.h"
#include "../wanderer/WandererHead.h"
#include "../wanderer/WandererLantern.h"
#include "../wanderer/WandererMotions.h"
#include "../wanderer/WandererRig.h"
#include "PeopleCarried.h"
#include "PeopleCoats.h"
#include "PeopleGear.h"
#include "PeopleHeads.h"
#include "PeoplePaint.h"

#include <map>

namespace osgGpuAnimation::scenes
{

namespace
{

const char* const carriers[] = {"Basket", "Staff"};

/// The wanderer's rig, and a carrier for each thing that may take the lantern's place.
Rig makePeopleRig()
{
    Rig rig = makeWandererRig();
    for (const char* carrier : carriers)
        rig.addCarrier(carrier, "Hand_L", rig.head("Lantern"));
    return rig;
}

/// What is never hidden.
void addBody(CharacterMesh& mesh)
{
    mesh.wear("Body", "Skin");
    addWandererFace(mesh);
    addPeopleNeck(mesh);
    addPeopleEars(mesh);
    mesh.wear("Body", "Eyes");
    addWandererEyes(mesh);
    mesh.wear("Body", "Trousers");
    addWandererTrousers(mesh, peoplePaint::trousers);
    mesh.wear("Body", "Boots");
    addWandererBoots(mesh, peoplePaint::boot, peoplePaint::sole);
    mesh.wear("Body", "Gloves");
    addWandererGloves(mesh, peoplePaint::glove);
}

/// One texture for all materials: they have names of their own so that each can have a colour of its own.
void addGarments(GltfDocument& document, const Rig& rig, int skin)
{
    CharacterMesh parts(rig, 0.72);
    addBody(parts);
    addPeopleHeads(parts);
    addPeopleCoats(parts);
    addPeopleGear(parts);
    parts.finish();

    const int colours = document.addTexture("People", encodePng(parts.atlas().pixels(), Atlas::size, Atlas::size));
    const int side = Atlas::reflectionSize;
    const int reflections =
        document.addTexture("PeopleReflections", encodePng(parts.atlas().reflections(), side, side));
    std::map<std::string, int> materials;
    std::map<std::string, int> meshes;
    for (const auto& [garment, material] : parts.primitives())
    {
        if (materials.count(material) == 0)
        {
            tinygltf::Material made;
            made.name = material;
            made.pbrMetallicRoughness.baseColorTexture.index = colours;
            made.pbrMetallicRoughness.metallicRoughnessTexture.index = reflections;
            materials[material] = document.addMaterial(made);
        }
        if (meshes.count(garment) == 0)
        {
            meshes[garment] = document.addMesh(garment);
            const int node = document.addNode(garment, -1);
            document.node(node).mesh = meshes[garment];
            document.node(node).skin = skin;
        }
        document.addPrimitive(meshes[garment], parts.arrays(garment, material), materials[material]);
    }
}

/// The lantern; in the variant "unlit" its glass does not glow.
int addLantern(GltfDocument& document)
{
    const int lantern = addWandererLantern(document);
    tinygltf::Material glass;
    glass.name = "Glass";
    glass.pbrMetallicRoughness.baseColorFactor = {0.62, 0.60, 0.50, 1.0};
    glass.pbrMetallicRoughness.metallicFactor = 0.0;
    glass.pbrMetallicRoughness.roughnessFactor = 0.12;
    document.setVariantMaterial(lantern, document.addVariant("unlit"), document.addMaterial(glass));
    return lantern;
}

/// The clip with the left hand's thumb up, as one holds a staff, and with all carriers posed like the lantern.
Motion carrying(Motion motion)
{
    motion.pose = [wanderers = motion.pose](double phase, RigPose& pose)
    {
        wanderers(phase, pose);
        const glm::dquat lantern = pose.modelTurn("Lantern");
        const glm::dvec3 along = glm::normalize(pose.modelPosition("Fingers_L") - pose.modelPosition("Hand_L"));
        const glm::dquat lower = pose.modelTurn("LowerArm_L"), hand = pose.modelTurn("Hand_L");
        pose.turnInModel("LowerArm_L", degreesAbout(-30.0, along) * lower);
        pose.turnInModel("Hand_L", degreesAbout(-62.0, along) * hand);
        pose.turnInModel("Lantern", lantern);
        pose.turnInModel("Basket", lantern);
        pose.turnInModel("Staff", glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), lantern, 0.5));
    };
    return motion;
}

} // namespace

void writePeople(const std::string& path)
{
    const Rig rig = makePeopleRig();
    GltfDocument document("People");
    const int root = document.addNode("Armature", -1);
    const std::vector<int> nodes = addRigNodes(document, rig, root);

    addGarments(document, rig, addRigSkin(document, "People", rig, nodes));
    document.node(nodes[rig.index("Lantern")]).mesh = addLantern(document);
    document.node(nodes[rig.index("Basket")]).mesh = addPeopleBasket(document);
    document.node(nodes[rig.index("Staff")]).mesh = addPeopleStaff(document);

    for (const Motion& motion : {wandererIdle(), wandererWalk(), wandererRun(), wandererWave()})
        addClip(document, rig, nodes, carrying(motion));
    document.write(path);
}

} // namespace osgGpuAnimation::scenes
