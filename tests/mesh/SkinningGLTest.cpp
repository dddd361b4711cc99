// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <glm/geometric.hpp>
#include <osg/Program>
#include <ShaderSources.h>

// Positions and normals of skin.glsl, captured by transform feedback, are those of the CPU twin.

namespace osgGpuAnimation
{

namespace
{

constexpr int vertexCount = 60;

struct SkinCase
{
    const char* name;
    int influences; ///< 0: rigid
    int morph;      ///< of the set: 5 or 30 targets; -1: none
    bool isMirrored = false;
    bool hasDefines = false; ///< shader defines remove the parts that the mesh does not need
};

void PrintTo(const SkinCase& skin, std::ostream* out)
{
    *out << skin.name;
}

class SkinningGLTest : public GLTest, public ::testing::WithParamInterface<SkinCase>
{
protected:
    struct Vertex
    {
        glm::vec3 position, normal;
    };

    float number(double low, double high)
    {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(_random));
    }

    osg::ref_ptr<osg::Vec3Array> vectors(double size)
    {
        osg::ref_ptr<osg::Vec3Array> array = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
        for (int vertex = 0; vertex < vertexCount; ++vertex)
            array->push_back(osg::Vec3(number(-size, size), number(-size, size), number(-size, size)));
        return array;
    }

    /// Weights that do not sum to 1.
    void setInfluences(SkinnedGeometry& mesh, const std::vector<int>& entries, int count)
    {
        for (int set = 0; 4 * set < count; ++set)
        {
            osg::ref_ptr<osg::Vec4usArray> places = new osg::Vec4usArray(vertexCount);
            osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(vertexCount);
            for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
                for (int i = 0; i < 4; ++i)
                {
                    (*places)[vertex][i] = static_cast<GLushort>(entries[_random() % entries.size()]);
                    (*weights)[vertex][i] = 4 * set + i < count ? number(0.05, 0.6) : 0.0f;
                }
            mesh.setInfluences(static_cast<unsigned int>(set), places, weights);
        }
    }

    /// Some targets have no positions, others no normals.
    std::vector<MorphTarget> targets(std::size_t count)
    {
        std::vector<MorphTarget> targets(count);
        for (std::size_t target = 0; target < count; ++target)
        {
            if (target % 3 != 1) targets[target].positions = vectors(0.3);
            if (target % 3 != 2) targets[target].normals = vectors(0.3);
        }
        return targets;
    }

    osg::ref_ptr<SkinnedGeometry> makeMesh(const AnimationSet& set)
    {
        osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
        mesh->setVertexArray(vectors(1.0));
        mesh->setNormalArray(vectors(1.0), osg::Array::BIND_PER_VERTEX);
        mesh->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, vertexCount));
        if (GetParam().influences > 0)
            setInfluences(*mesh, set.entriesOfSkin(1), GetParam().influences);
        else
            mesh->setRigidEntry(static_cast<unsigned short>(set.entriesOfSkin(0)[3]));
        const int morph = GetParam().morph;
        if (morph >= 0)
            mesh->setMorphTargets(set, static_cast<std::size_t>(morph),
                                  targets(set.morphs()[static_cast<std::size_t>(morph)].defaults.size()));
        return mesh;
    }

    static osg::ref_ptr<osg::Program> captureProgram()
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(skinShader());
        program->addShader(
            new osg::Shader(osg::Shader::VERTEX, std::string(shaders::version_glsl) + shaders::capture_vert));
        bindSkinAttributes(*program);
        program->addTransformFeedBackVarying("capturedPosition");
        program->addTransformFeedBackVarying("capturedNormal");
        program->setTransformFeedBackMode(GL_INTERLEAVED_ATTRIBS);
        return program;
    }

    std::vector<Vertex> capture(const SkinnedGeometry& mesh, const std::shared_ptr<const AnimationSet>& set,
                                std::size_t instance)
    {
        osg::ref_ptr<PaletteBinding> binding = new PaletteBinding;
        binding->set(set, 0, instance);
        osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
        stateSet->setAttribute(binding);
        stateSet->setAttributeAndModes(captureProgram());
        if (GetParam().hasDefines) applySkinDefines(*stateSet, mesh.getInfluenceCount(), GetParam().morph >= 0);
        state().pushStateSet(stateSet);
        if (osg::StateSet* ofMesh = mesh.meshState()) state().pushStateSet(ofMesh);
        state().apply();

        const osg::GLExtensions* gl = state().get<osg::GLExtensions>();
        std::vector<Vertex> vertices(vertexCount);
        const auto bytes = static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex));
        GLuint buffer = 0;
        gl->glGenBuffers(1, &buffer);
        gl->glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
        gl->glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STREAM_READ_ARB);
        gl->glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
        osg::RenderInfo renderInfo(&state(), nullptr);
        gl->glBeginTransformFeedback(GL_POINTS);
        mesh.draw(renderInfo);
        gl->glEndTransformFeedback();
        gl->glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, vertices.data());
        gl->glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
        gl->glDeleteBuffers(1, &buffer);
        state().popAllStateSets();
        state().apply();
        return vertices;
    }

private:
    std::mt19937 _random{20261122};
};

const SkinCase skinCases[] = {
    {"RigidMirroredFiveTargets", 0, 0, true},
    {"FourInfluencesMirroredThirtyTargets", 4, 1, true},
    {"FiveInfluences", 5, -1, true},
    {"EightInfluencesFiveTargets", 8, 0},
    {"TwoInfluencesDefines", 2, -1, false, true},
    {"SevenInfluencesMirroredThirtyTargetsDefines", 7, 1, true, true},
};

TEST_P(SkinningGLTest, agreesWithTheCpuTwin)
{
    const auto set = makeRandomSet({11, 16, 6, 5, false, true, true});
    const osg::ref_ptr<SkinnedGeometry> mesh = makeMesh(*set);
    AffineMatrix root; // sheared
    root.rows = {glm::vec4(GetParam().isMirrored ? -0.8f : 0.8f, 0.3f, 0, 1), glm::vec4(0.1f, 1.2f, -0.4f, 2),
                 glm::vec4(0.2f, 0, 0.9f, -1)};
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    PoseBatch batch(set);
    std::vector<PoseInstruction> instructions;
    for (int i = 0; i < 3; ++i)
    {
        instructions.push_back(instructionAt(*set, i, 0.4 + 0.3 * i));
        batch.add(instructions.back(), root);
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t instance = 0; instance < instructions.size(); ++instance)
    {
        std::vector<AffineMatrix> palette;
        Pose::evaluate(*set, instructions[instance], root, palette);
        std::vector<glm::dvec3> positions, normals;
        mesh->computePositions(palette, positions);
        mesh->computeNormals(palette, normals);
        ASSERT_EQ(normals.size(), std::size_t(vertexCount));
        const std::vector<Vertex> found = capture(*mesh, set, instance);
        for (std::size_t vertex = 0; vertex < found.size(); ++vertex)
        {
            SCOPED_TRACE(testing::Message() << "instance " << instance << ", vertex " << vertex);
            const double distance = 1.0 + glm::length(positions[vertex]), length = 1.0 + glm::length(normals[vertex]);
            EXPECT_LE(glm::length(glm::dvec3(found[vertex].position) - positions[vertex]), 1e-5 * distance);
            EXPECT_LE(glm::length(glm::dvec3(found[vertex].normal) - normals[vertex]), 3e-5 * length);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Skins, SkinningGLTest, ::testing::ValuesIn(skinCases),
                         [](const auto& info) { return std::string(info.param.name); });

// Normals of the CPU twin: a target's array may be short, and there are none without one a vertex.
TEST(SkinnedNormalsTest, shortArraysAreReadAsFarAsTheyGo)
{
    const osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->setVertexArray(new osg::Vec3Array(2));
    mesh->setNormalArray(new osg::Vec3Array(1), osg::Array::BIND_OVERALL);
    mesh->setRigidEntry(0);
    MorphTarget target;
    target.positions = new osg::Vec3Array(1);
    target.positions->front().z() = 1.0f;
    mesh->setMorphTargets(0, 1, {target});
    std::vector<AffineMatrix> palette(2);
    palette[1].rows[0].x = 0.75f;
    std::vector<glm::dvec3> positions, normals(7);
    mesh->computePositions(palette, positions);
    EXPECT_EQ(positions, (std::vector<glm::dvec3>{{0.0, 0.0, 0.75}, {0.0, 0.0, 0.0}}));
    for (osg::Array* none : {mesh->getNormalArray(), static_cast<osg::Array*>(nullptr)})
    {
        mesh->setNormalArray(none);
        mesh->computeNormals(palette, normals);
        EXPECT_TRUE(normals.empty());
        normals.resize(7);
    }
}

} // namespace

} // namespace osgGpuAnimation
