// SPDX-License-Identifier: MIT
#include "plugin/BumpyTubes.h"
#include "serializers/StoredTest.h"

#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <cstring>

// Scenes with levels of detail keep them: reading creates none, unless the stored ones have a fault.

namespace osgGpuAnimation
{

namespace
{

using Read = osgDB::ReaderWriter::ReadResult;

std::vector<SkinnedGeometry*> meshesOf(const osg::Group& group)
{
    std::vector<SkinnedGeometry*> meshes;
    forEachMesh(group, [&](const SkinnedGeometry& mesh) { meshes.push_back(const_cast<SkinnedGeometry*>(&mesh)); });
    return meshes;
}

std::size_t stepsOf(const SkinnedGeometry& mesh)
{
    const std::shared_ptr<const LodLevels> levels = MeshDetail::findLevels(mesh);
    return levels ? levels->steps(0).size() : 0;
}

void expectSameElements(const osg::DrawElements& expected, const osg::DrawElements& found)
{
    ASSERT_EQ(found.getNumIndices(), expected.getNumIndices());
    for (unsigned int i = 0; i < expected.getNumIndices(); ++i)
        ASSERT_EQ(found.index(i), expected.index(i)) << "index " << i;
}

void expectSameLevels(const SkinnedGeometry& expected, const SkinnedGeometry& found)
{
    const std::shared_ptr<const LodLevels> before = MeshDetail::findLevels(expected),
                                           after = MeshDetail::findLevels(found);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(after->finest(), before->finest());
    EXPECT_EQ(after->coarsest(), before->coarsest());
    for (unsigned int i = 0; i < expected.getNumPrimitiveSets(); ++i)
    {
        ASSERT_EQ(after->steps(i).size(), before->steps(i).size());
        for (std::size_t step = 0; step < before->steps(i).size(); ++step)
        {
            const LodLevels::Step &first = before->steps(i)[step], &second = after->steps(i)[step];
            EXPECT_EQ(second.level, first.level);
            EXPECT_EQ(second.outset, first.outset);
            EXPECT_EQ(second.error, first.error);
            EXPECT_EQ(second.elements->getElementBufferObject() != nullptr, true);
            expectSameElements(*first.elements, *second.elements);
        }
    }
}

void expectSameMerged(const AnimatedCrowd& expected, const AnimatedCrowd& found)
{
    ASSERT_TRUE(CrowdDetail::levels(expected) && CrowdDetail::levels(found));
    EXPECT_TRUE(CrowdDetail::levels(found)->isOf(found, found.getAnimationSet()));
    const auto &before = CrowdDetail::levels(expected)->merged(), &after = CrowdDetail::levels(found)->merged();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i)
    {
        EXPECT_EQ(after[i].parts, before[i].parts);
        ASSERT_EQ(after[i].steps.size(), before[i].steps.size());
        for (std::size_t step = 0; step < before[i].steps.size(); ++step)
        {
            const CharacterLevels::Step &first = before[i].steps[step], &second = after[i].steps[step];
            EXPECT_EQ(second.level, first.level);
            EXPECT_EQ(second.error, first.error);
            ASSERT_EQ(second.mesh->getVertexCount(), first.mesh->getVertexCount());
            EXPECT_EQ(second.mesh->getInfluenceCount(), first.mesh->getInfluenceCount());
            osg::Geometry::ArrayList arrays, again;
            first.mesh->getArrayList(arrays);
            second.mesh->getArrayList(again);
            ASSERT_EQ(again.size(), arrays.size());
            for (std::size_t array = 0; array < arrays.size(); ++array)
            {
                const unsigned int size = arrays[array]->getTotalDataSize();
                ASSERT_EQ(again[array]->getTotalDataSize(), size);
                EXPECT_EQ(std::memcmp(again[array]->getDataPointer(), arrays[array]->getDataPointer(), size), 0);
            }
            expectSameElements(*first.mesh->getPrimitiveSet(0)->getDrawElements(),
                               *second.mesh->getPrimitiveSet(0)->getDrawElements());
        }
    }
}

/// Levels that nothing creates: without the first step, and with other errors.
void changeLevels(SkinnedGeometry& mesh)
{
    std::vector<LodLevels::Steps> levels;
    for (unsigned int i = 0; i < mesh.getNumPrimitiveSets(); ++i)
    {
        levels.push_back(MeshDetail::findLevels(mesh)->steps(i));
        if (!levels.back().empty()) levels.back().erase(levels.back().begin());
        for (LodLevels::Step& step : levels.back())
            step.error /= 3.0;
    }
    MeshDetail::setLevels(mesh, LodLevels::restored(mesh, levels).value());
}

void changeLevels(AnimatedCrowd& crowd)
{
    for (SkinnedGeometry* mesh : meshesOf(crowd))
        changeLevels(*mesh);
    std::vector<CharacterLevels::Merged> merged = CrowdDetail::levels(crowd)->merged();
    for (CharacterLevels::Merged& parts : merged)
    {
        if (parts.steps.size() > 1) parts.steps.erase(parts.steps.begin());
        for (CharacterLevels::Step& step : parts.steps)
            step.error /= 3.0;
    }
    CrowdDetail::setLevels(crowd, CharacterLevels::restored(crowd, crowd.getAnimationSet(), merged).value());
}

struct LevelFault
{
    const char* name;
    const char* pattern; ///< a regular expression for what is in the .osgt …
    const char* instead; ///< … once
    const char* message; ///< null: none
};

class StoredLevelsTest : public StoredSceneTest
{
protected:
    void SetUp() override
    {
        readModel(gltf::bumpyTubes());
        ASSERT_TRUE(character().getMeshes().setPixelError(0.5f));
        crowd = new AnimatedCrowd(character());
        ASSERT_TRUE(crowd->getMeshes().setPixelError(0.5f));
        crowd->getMeshes().waitForLevels();
        ASSERT_TRUE(crowd->add({}, AnimationController(crowd->getSharedAnimationSet())));
        StoredSceneTest::SetUp();
    }

    std::string stored(const std::string& format) const
    {
        const std::string file = files.folder.file("crowd." + format);
        EXPECT_TRUE(osgDB::writeNodeFile(*crowd, file));
        return readBytes(file);
    }

    /// The crowd of a sound .osgt with a fault, which costs no mesh. Null, with a failure: there is none.
    osg::ref_ptr<AnimatedCrowd> readFaulty(const std::string& sound, const LevelFault& fault)
    {
        Read result = readContent("faulty.osgt", replaced(sound, fault.pattern, fault.instead));
        EXPECT_NE(log->text.find(fault.message), std::string::npos) << log->text << result.message();
        const osg::ref_ptr<AnimatedCrowd> back = dynamic_cast<AnimatedCrowd*>(result.getNode());
        EXPECT_TRUE(back) << result.message();
        EXPECT_EQ(back ? meshesOf(*back).size() : 0, 2u);
        if (back) back->getMeshes().waitForLevels();
        return back;
    }

    osg::ref_ptr<AnimatedCrowd> crowd;
};

const LevelFault levelFaults[] = {
    {"another vertex", "(Vec3Array [^]*?vector 144 .*\n *)[^ ]+", "$1 0.25", "mesh \"upper\" are made anew: its vert"},
    {"another checksum", "Checksum -?[0-9]+", "Checksum 12", "mesh \"upper\" are made anew: its vertices or primit"},
    {"a list too few", "Levels 1 \\{\\s*Steps", "Levels 2 {\nSteps 0 {\n}\nSteps", "2 lists of levels for 1 primi"},
    {"no list", "(Checksum [^ ]+\\s*)Levels 1 \\{[^]*?(Indices [^]*?\\}\\s*)+\\}\\s*\\}", "$1Levels 0 {\n}", "0 lists"},
    {"the same level twice", "Step (-?[0-9]+)([^]*?)Step -?[0-9]+", "Step $1$2Step $1", "primitive set 0, step 1: lev"},
    {"a level that overflows", "Step -?[0-9]+", "Step 2147483647", "primitive set 0, step 0: level 2147483647"},
    {"the level of all triangles", "Step -?[0-9]+", "Step -2147483648", "primitive set 0, step 0: level -2147483648"},
    {"an error that is not a number", "Step (-?[0-9]+) [^ ]+", "Step $1 nan", "primitive set 0, step 0: level"},
    {"an infinite error", "Step (-?[0-9]+) [^ ]+", "Step $1 inf", "primitive set 0, step 0: level"},
    {"an error below 0", "Step (-?[0-9]+) [^ ]+", "Step $1 -1", "primitive set 0, step 0: level"},
    {"an infinite outset", "Step (-?[0-9]+) ([^ ]+) [^ ]+", "Step $1 $2 inf", "an outset of inf"},
    {"an outset below 0", "Step (-?[0-9]+) ([^ ]+) [^ ]+", "Step $1 $2 -1", "an outset of -1"},
    {"the vertex behind the last", "(Indices [^\n]*\n *)[0-9]+", "$1 144", "whole triangles of 144 vertices"},
    {"half a triangle", "Indices [0-9]+ \\{[^}]*", "Indices 4 {\n0 1 2 3\n", "step 0: 4 indices that are not whole"},
    {"no triangles", "Indices [0-9]+ \\{[^}]*", "Indices 0 {\n", "step 0: 0 indices that are not whole"},
};

const LevelFault mergedFaults[] = {
    {"another checksum", "(Instances 1[^]*?)Checksum -?[0-9]+", "$1Checksum 12", "its meshes have changed"},
    {"a part that is not there", "Parts 2 \\{\\s*0 1", "Parts 2 {\n0 2", "merged parts 0: part 2 of 2"},
    {"a part twice", "Parts 2 \\{\\s*0 1", "Parts 2 {\n1 1", "merged parts 0: part 1 of 2"},
    {"no parts", "Parts 2 \\{\\s*0 1", "Parts 0 {\n", "merged parts 0: no parts"},
    {"an infinite error", "(Parts [^]*?Step -?[0-9]+ )[^ ]+", "$1 inf", "merged parts 0: level"},
    {"an error below 0", "(Parts [^]*?Step -?[0-9]+ )[^ ]+", "$1 -1", "merged parts 0: level"},
    {"a level that overflows", "(Parts [^]*?Step )-?[0-9]+", "$1 77777", "merged parts 0: level 77777"},
    {"another object as the mesh", "(Parts [^]*?)osgGpuAnimation::SkinnedGeometry \\{", "$1osg::Geometry {", "no mesh"},
    {"an entry out of range", "(Parts [^]*?Vec4usArray [^]*?vector .*\n *)[0-9]+", "$1 500", "500 as an entry"},
    {"a vertex out of range", "(Parts [^]*?DrawElementsUShort [^]*?vector .*\n *)[0-9]+", "$1 999", "a primitive set"},
};

} // namespace

TEST_F(StoredLevelsTest, comeBackAsTheyWere)
{
    ASSERT_GT(stepsOf(*meshesOf(*crowd).front()), 1u);
    ASSERT_FALSE(CrowdDetail::levels(*crowd)->merged().empty());
    changeLevels(*crowd); // shares its meshes with the character
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> read = files.throughFile(*crowd, format),
                                      other = files.throughFile(*scene, format);
        ASSERT_TRUE(read && other && findCharacter(*other));
        const auto* back = dynamic_cast<AnimatedCrowd*>(read.get());
        ASSERT_TRUE(back);
        expectSameMerged(*crowd, *back);
        for (const osg::Group* group : std::initializer_list<const osg::Group*>{back, findCharacter(*other)})
            for (std::size_t mesh = 0; mesh < 2; ++mesh)
                expectSameLevels(*meshesOf(*crowd)[mesh], *meshesOf(*group)[mesh]);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredLevelsTest, areMadeWhereAFileHasNone)
{
    const osg::ref_ptr<AnimatedCrowd> before = new AnimatedCrowd(*crowd);
    CrowdDetail::setLevels(*before, CrowdDetail::levels(*crowd));
    for (SkinnedGeometry* mesh : meshesOf(*crowd))
        MeshDetail::forgetLevels(*mesh);
    for (CharacterMeshes* each : {&crowd->getMeshes(), &before->getMeshes(), &findCharacter(*scene)->getMeshes()})
        ASSERT_TRUE(each->setPixelError(0.0f)); // a writer waits for those of all nodes with the meshes
    EXPECT_EQ(stored("osgt").find("Levels"), std::string::npos);
    for (const char* format : storedFormats)
    {
        const osg::ref_ptr<osg::Node> read = files.throughFile(*crowd, format);
        auto* back = dynamic_cast<AnimatedCrowd*>(read.get());
        ASSERT_TRUE(back);
        ASSERT_TRUE(back->getMeshes().setPixelError(0.5f));
        back->getMeshes().waitForLevels();
        EXPECT_GT(stepsOf(*meshesOf(*back).front()), 1u);
        expectSameMerged(*before, *back);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredLevelsTest, writersWaitForThoseOfChangedMeshes)
{
    const std::shared_ptr<const CharacterLevels> before = CrowdDetail::levels(*crowd);
    for (SkinnedGeometry* mesh : meshesOf(*crowd))
        mesh->getVertexArray()->dirty();
    const std::string text = stored("osgt");
    EXPECT_NE(text.find("Levels"), std::string::npos);
    EXPECT_NE(text.find("Merged"), std::string::npos);
    EXPECT_NE(CrowdDetail::levels(*crowd), before);
}

TEST_F(StoredLevelsTest, faultsCostTheLevelsAlone)
{
    const std::string sound = stored("osgt");
    for (const LevelFault& fault : mergedFaults)
    {
        SCOPED_TRACE(fault.name);
        const osg::ref_ptr<AnimatedCrowd> back = readFaulty(sound, fault);
        ASSERT_TRUE(back);
        expectSameMerged(*crowd, *back); // made anew
    }
    const std::size_t steps = stepsOf(*meshesOf(*crowd).front());
    changeLevels(*crowd);
    for (const LevelFault& fault : levelFaults)
    {
        SCOPED_TRACE(fault.name);
        const osg::ref_ptr<AnimatedCrowd> back = readFaulty(sound, fault);
        ASSERT_TRUE(back);
        EXPECT_GE(stepsOf(*meshesOf(*back).front()) + 1, steps) << "made anew";
    }
}

/// OSG's own reader is not proof against changes in the rest of a mesh.
TEST_F(StoredLevelsTest, changedAndMissingBytesDoNoHarm)
{
    const std::string sound = stored("osgb");
    const LodLevels::Steps steps = MeshDetail::findLevels(*meshesOf(*crowd).front())->steps(0);
    const auto placeOf = [&](const osg::DrawElements& elements) {
        return sound.find(
            std::string(static_cast<const char*>(elements.getDataPointer()), elements.getTotalDataSize()));
    };
    constexpr std::size_t header = 37; // from the checksum to the first index
    const std::size_t first = placeOf(*steps.front().elements) - header;
    const std::size_t last = placeOf(*steps.back().elements) + steps.back().elements->getTotalDataSize();
    ASSERT_LT(last, sound.size());
    std::size_t errors = 0, warnings = 0;
    for (std::size_t at = first; at < last; at += at < first + header ? 1 : 19)
    {
        std::string changed = sound;
        changed[at] = static_cast<char>(changed[at] ^ (at % 2 ? 0xFF : 0x7F));
        errors += !readContent("changed.osgb", changed).validNode();
        warnings += log->text.find("made anew") != std::string::npos;
        EXPECT_FALSE(readContent("cut.osgb", sound.substr(0, at)).validNode()) << at;
    }
    EXPECT_GT(errors, 5u);
    EXPECT_GT(warnings, 20u);
}

} // namespace osgGpuAnimation
