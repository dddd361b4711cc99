// SPDX-License-Identifier: MIT
#include "serializers/StoredTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

// Stored scenes are untrusted: every fault gives a message, and the rest of the scene can be updated.

namespace osgGpuAnimation
{

namespace
{

using Read = osgDB::ReaderWriter::ReadResult;

enum class Answer
{
    Error,     ///< nothing is read; the message says why
    NoMesh,    ///< a warning, and one mesh less
    NoPlaying, ///< a warning, and the layer does not play
    NoFault    ///< replaced by the nearest valid value
};

struct FaultCase
{
    const char* name;
    const char* pattern; ///< a regular expression for what is in the .osgt …
    const char* instead; ///< … once
    Answer answer;
    const char* message;
};

const FaultCase faults[] = {
    {"another version", "Contents 1", "Contents 2", Answer::Error, "an animation set has version 2, expected 1"},
    {"a version that is no number", "Contents 1", "Contents x", Answer::Error, "\"x\""},
    {"too few joints", "Joints 3 ", "Joints 2 ", Answer::Error, "Skins"},
    {"too many joints", "Joints 3 ", "Joints 4000000000 ", Answer::Error, "Joint"},
    {"a number of joints below 0", "Joints 3 ", "Joints -3 ", Answer::Error, "-3"},
    {"a parent that is not there", "Joint 0 2 ", "Joint 7 2 ", Answer::Error, "parent 7"},
    {"parents in a circle", "Joint -1 0 arm", "Joint 1 0 arm", Answer::Error, "circle"},
    {"parents out of order", "(Joint -1 0 arm.*\n)( *Joint 0 1 .*\n)", "$2$1", Answer::Error, "joint 0"},
    {"a rest pose that is not finite", "Joint 0 1 sword 0", "Joint 0 1 sword nan", Answer::Error, "not finite"},
    {"a rest pose that is a word", "Joint 0 1 sword 0", "Joint 0 1 sword zero", Answer::Error, "zero"},
    {"a skin's joint out of range", "(InverseBinds 2 .*\n *)Joint 0", "$1Joint 9", Answer::Error, "joint 0 is 9"},
    {"an inverse bind that is infinite", "(InverseBinds 2 .*\n *)Joint 0 1", "$1Joint 0 inf", Answer::Error, "finite"},
    {"a rigid joint out of range", "RigidJoints 1 1", "RigidJoints 1 99", Answer::Error, "rigid joint 99"},
    {"times that descend", "(Times 2 .*\n *)0 1 ", "$1 5 1 ", Answer::Error, "time 1"},
    {"times below 0", "(Times 2 .*\n *)0 1 ", "$1 -1 1 ", Answer::Error, "time 0"},
    {"times that are not finite", "(Times 2 .*\n *)0 1 ", "$1 0 inf ", Answer::Error, "time 1"},
    {"no times", "Times 2 .*\n *0 1 ", "Times 0 {\n", Answer::Error, "no keyframes"},
    {"fewer keyframes than times", "Keyframes 72 ", "Keyframes 60 ", Answer::Error, "Markers"},
    {"more keyframes than there are", "Keyframes 72 ", "Keyframes 4294967295 ", Answer::Error, "}"},
    {"a rotation of length 0", "(Keyframes 72 .*\n *0 0 0 0 0 0 0 )1", "$1 0", Answer::Error, "length 0"},
    {"a keyframe that is not finite", "(Keyframes 72 .*\n *)0", "$1 nan", Answer::Error, "not finite"},
    {"a marker before the clip", "Markers 0 \\{", "Markers 1 {\nMarker -2 step\n", Answer::Error, "step"},
    {"a motion without its keys", "RootMotion 0 \\{",
     "RootMotion 1 {\nJoint 0 0 1 0 Key 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
     "0 0 0 0\n",
     Answer::Error, "1 keys for 2"},
    {"a motion of no joint", "RootMotion 0 \\{",
     "RootMotion 1 {\nJoint 9 0 1 0 Key 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
     "0\n",
     Answer::Error, "root motion does not exist"},
    {"another controller", "Controller 1", "Controller 4", Answer::Error, "a controller has version 4, expected 1"},
    {"nine layers", "Layers 1 ", "Layers 9 ", Answer::Error, "9 layers"},
    {"a state that there is not", "Layer 1 1 1", "Layer 4 1 1", Answer::Error, "state is 4"},
    {"a loop mode that there is not", "Layer 1 1 1", "Layer 1 3 1", Answer::Error, "loop mode is 3"},
    {"a speed that is not finite", "Layer 1 1 1", "Layer 1 1 nan", Answer::NoPlaying, "speed"},
    {"a clip that is not there", "ActiveClip 0 ", "ActiveClip 2 ", Answer::NoPlaying, "clip 2 of 2"},
    {"a time that is not finite", "ActiveClip 0 0", "ActiveClip 0 inf", Answer::NoPlaying, "time"},
    {"a share above 1", "ActiveClip 0 0 1 1 0 1 1 ", "ActiveClip 0 0 1 1 0 1 2 ", Answer::NoPlaying, "share"},
    {"in step with nobody", "(ActiveClip 0 0 1 1 0 1 1 0) 0", "$1 77", Answer::NoPlaying, "step"},
    {"playing, but nothing", "ActiveClips 1 .*\n *ActiveClip .*\n", "ActiveClips 0 {\n", Answer::NoPlaying, "no clip"},
    {"a mask of another set", "Mask 0 \\{", "Mask 2 {\n0.5 0.5\n", Answer::NoPlaying, "mask"},
    {"a weight that cannot be", "Weight 1 ", "Weight nan ", Answer::NoPlaying, "fade"},
    {"a rigid entry out of range", "Influences [0-9]+ ", "Influences 900 ", Answer::NoMesh, "900 as an entry"},
    {"a rigid entry that no vertex can name", "Influences [0-9]+ ", "Influences 70000 ", Answer::Error, "70000"},
    {"an entry out of range", "(Vec4usArray [^]*?vector 3 .*\n *)[0-9]+ ", "$1 500 ", Answer::NoMesh,
     "500 as an entry"},
    {"influences for fewer vertices", "(Vec4usArray [^]*?)vector 3 .*\n.*\n.*\n", "$1vector 1 {\n", Answer::NoMesh,
     "1 elements"},
    {"vertices that are not there", "osg::DrawArrays \\{([^]*?)Count 3", "osg::DrawArrays {$1Count 300", Answer::NoMesh,
     "a primitive set"},
    {"the vertex behind the last", "osg::DrawArrays \\{([^]*?)Count 3", "osg::DrawArrays {$1Count 4", Answer::NoMesh,
     "a primitive set"},
    {"no property of a set", "AnimationSet \\{", "Other {", Answer::Error, "without its AnimationSet"},
    {"no controller", "Controller 1", "Other 1", Answer::Error, "without its Controller"},
    {"no influences", "Influences -?[0-9]+", "Other 1", Answer::Error, "without its Influences"},
    {"a set without contents", "Contents 1", "Other 1", Answer::Error, "without its Contents"},
    {"no set", "osgGpuAnimation::StoredAnimationSet \\{\n *UniqueID", "osg::Group {\nUniqueID", Answer::Error, ""},
    {"another object as the set", "osgGpuAnimation::StoredAnimationSet \\{\n *UniqueID [0-9]+",
     "osgGpuAnimation::StoredAnimationSet {\nUniqueID 1", Answer::Error, "without an animation set"},
};

// 34 words a track, of which floats are the bits: place, three counts of bits, base and step of the translation, the
// same of the rotation with the omitted component, the same of the scale. The first track slides.
const char noFit[] = "compact keyframes do not fit";
const FaultCase compactFaults[] = {
    {"a place beyond the record", "(Compact 102 \\{\\s+)0 ", "$01128 ", Answer::Error, noFit},
    {"a place below none", "(Compact 102 \\{\\s+)0 ", "$014294967289 ", Answer::Error, noFit},
    {"numbers across texels", "(Compact 102 \\{\\s+)0 ", "$01127 ", Answer::Error, noFit},
    {"a number of too many bits", "(Compact 102 \\{\\s+0) 10 ", "$01 21 ", Answer::Error, noFit},
    {"a negative count of bits", "(Compact 102 \\{\\s+0) 10 ", "$01 4294967295 ", Answer::Error, noFit},
    {"a count of bits without an opposite", "(Compact 102 \\{\\s+0) 10 ", "$01 2147483648 ", Answer::Error, noFit},
    {"a base that is not finite", "(Compact 102 \\{\\s+0 10 0 0) 0 ", "$01 2139095040 ", Answer::Error, noFit},
    {"no component of a rotation", "(Compact 102 \\{(?:\\s+[0-9]+){20}) 3 ", "$01 5 ", Answer::Error, noFit},
    {"fewer joints", "Compact 102 ", "Compact 68 ", Answer::Error, ""},
    {"more joints", "Compact 102 ", "Compact 4000000000 ", Answer::Error, "expected a number"},
    {"less that is held", "Held 36 ", "Held 24 ", Answer::Error, ""},
    {"a record of no texels", "RecordSize 1", "RecordSize 0", Answer::Error, noFit},
    {"a record that is too large", "RecordSize 1", "RecordSize 4000000000", Answer::Error, noFit},
    {"fewer records", "Records 8 \\{\\s+0 0 0 0 ", "Records 4 {\n ", Answer::Error, noFit},
    {"another number", "(Records 8 \\{\\s+)[0-9]+ ", "$01 77 ", Answer::NoFault, ""},
    {"weights of nobody", "Weights 0 \\{", "Weights 12 {\n0 0 0 0 0 0 0 0 0 0 0 0\n", Answer::Error, "the numbers"},
    {"a Spline that is compact", "Clip Slide 0 1", "Clip Slide 1 1", Answer::Error, noFit},
    {"exact keyframes", "Clip Slide 0 1", "Clip Slide 0 0", Answer::Error, "Keyframes"},
};

class FaultyStoredScenesTest : public StoredSceneTest
{
protected:
    void SetUp() override
    {
        StoredSceneTest::SetUp();
        write("arm", nullptr);
        write("compact", new osgDB::Options("compact=0.001"));
    }

    void write(const std::string& name, const osgDB::Options* options)
    {
        gltf::ModelBuilder model;
        const int arm = model.node("arm");
        model.node("sword", arm, model.triangle());
        const int hand = model.node("hand", arm);
        const int skinned = model.node("skinned", -1, model.skinnedTriangle());
        model.at(skinned).skin = model.skin({arm, hand});
        model.slidingClip("Slide", arm);
        model.slidingClip("Again", arm);
        const osg::ref_ptr<osg::Node> scene =
            osgDB::readRefNodeFile(files.folder.write(name + ".gltf", model.text()), options);
        ASSERT_TRUE(scene);
        meshes = findCharacter(*scene)->getNumChildren();
        for (const char* format : {".osgt", ".osgb", ".osgx"})
            ASSERT_TRUE(osgDB::writeNodeFile(*scene, files.folder.file(name + format)));
    }

    std::string content(const std::string& name) { return readBytes(files.folder.file(name)); }

    /// What is read must be usable.
    Read readAndUse(const std::string& name, const std::string& text)
    {
        Read result = readContent(name, text);
        if (result.validNode())
            if (AnimatedCharacter* character = findCharacter(*result.getNode()))
                for (int frame = 0; frame < 3; ++frame)
                {
                    character->update(0.3 * frame);
                    character->getBound();
                }
        return result;
    }

    void expectAnswer(const std::string& sound, const FaultCase& fault)
    {
        SCOPED_TRACE(fault.name);
        ASSERT_TRUE(readAndUse("sound.osgt", sound).validNode()) << log->text;
        Read result = readAndUse("faulty.osgt", replaced(sound, fault.pattern, fault.instead));
        const std::string said = result.message() + log->text;
        EXPECT_NE(said.find(fault.message), std::string::npos) << said;
        EXPECT_EQ(result.validNode(), fault.answer != Answer::Error) << said;
        AnimatedCharacter* character = result.validNode() ? findCharacter(*result.getNode()) : nullptr;
        if (!character) return;
        EXPECT_EQ(character->getNumChildren(), fault.answer == Answer::NoMesh ? meshes - 1 : meshes) << said;
        EXPECT_EQ(character->getController().clip(), fault.answer == Answer::NoPlaying ? -1 : 0) << said;
    }

    unsigned int meshes = 0;
};

} // namespace

TEST_F(FaultyStoredScenesTest, faultsHaveAMessage)
{
    for (const FaultCase& fault : faults)
        expectAnswer(content("arm.osgt"), fault);
    for (const FaultCase& fault : compactFaults)
        expectAnswer(content("compact.osgt"), fault);
}

TEST_F(FaultyStoredScenesTest, whatIsCutOffIsAnError)
{
    // Not inside one of OSG's quoted words: OSG would search for the closing quote forever. OSG's XML reader accepts a
    // file without its end and keeps the complete elements.
    for (const std::string name : {"arm.osgt", "arm.osgx", "compact.osgb"})
    {
        const std::string sound = content(name);
        const std::size_t first = sound.find("StoredAnimationSet");
        const std::size_t last = name == "compact.osgb" ? sound.size() - 64 : sound.rfind("RootMotion");
        ASSERT_LT(first, last);
        for (std::size_t length = first + 40; length < last; length += 31)
            EXPECT_FALSE(readAndUse("cut-" + name, sound.substr(0, length)).validNode()) << length;
    }
}

TEST_F(FaultyStoredScenesTest, changedBytesDoNoHarm)
{
    for (const char* name : {"arm.osgb", "compact.osgb"})
    {
        const std::string sound = content(name);
        const std::size_t first = sound.find("StoredAnimationSet") + 40;
        std::size_t errors = 0;
        for (std::size_t at = first; at < sound.size(); at += 3)
        {
            std::string changed = sound;
            changed[at] = static_cast<char>(changed[at] ^ (at % 2 ? 0xFF : 0x7F));
            errors += !readAndUse("changed.osgb", changed).validNode();
        }
        EXPECT_GT(errors, 50u) << name;
    }
}

} // namespace osgGpuAnimation
