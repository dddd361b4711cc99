// SPDX-License-Identifier: MIT
#include "GpuPasses.h"

#include "StagedViewer.h"

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/detail/Renderer.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/math/AffineMatrix.h>

#include <layout.glsl>

#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <random>

#ifndef GL_COPY_READ_BUFFER
#define GL_COPY_READ_BUFFER 0x8F36
#define GL_COPY_WRITE_BUFFER 0x8F37
#endif

namespace osgGpuAnimation::benchmark
{

namespace
{

osg::GLExtensions& glOf(osg::State& state)
{
    return *state.get<osg::GLExtensions>();
}

/// A vertex array object for the lifetime of a measurement.
struct VertexArray
{
    explicit VertexArray(osg::GLExtensions& gl) : gl(gl) { gl.glGenVertexArrays(1, &name); }
    ~VertexArray() { gl.glDeleteVertexArrays(1, &name); }
    VertexArray(const VertexArray&) = delete;
    VertexArray& operator=(const VertexArray&) = delete;

    osg::GLExtensions& gl;
    GLuint name = 0;
};

template <typename Element>
std::vector<Element> readBack(osg::GLExtensions& gl, GLuint buffer, std::size_t count)
{
    std::vector<Element> content(count);
    gl.glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    gl.glGetBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(Element)), content.data());
    gl.glBindBuffer(GL_TEXTURE_BUFFER, 0);
    return content;
}

} // namespace

double copySpeedOf(osg::State& state, std::size_t bytes)
{
    osg::GLExtensions& gl = glOf(state);
    void(GL_APIENTRY * copy)(GLenum, GLenum, GLintptr, GLintptr, GLsizeiptr) = nullptr;
    if (!osg::setGLExtensionFuncPtr(copy, "glCopyBufferSubData")) throw std::runtime_error("no glCopyBufferSubData");
    BufferTexture from(gl, GL_RGBA32F_ARB), to(gl, GL_RGBA32F_ARB);
    const std::vector<float> content(bytes / sizeof(float), 1.5f);
    from.upload(content.data(), bytes);
    to.reserve(bytes);
    gl.glBindBuffer(GL_COPY_READ_BUFFER, from.buffer());
    gl.glBindBuffer(GL_COPY_WRITE_BUFFER, to.buffer());
    const auto step = [&] { copy(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, static_cast<GLsizeiptr>(bytes)); };
    GpuClock clock(state);
    inARow(2, clock, step);
    std::vector<double> seconds;
    for (int round = 0; round < 5; ++round)
    {
        const Spent spent = inARow(4, clock, step);
        seconds.push_back(spent.gpu > 0.0 ? spent.gpu : isSoftwareRenderer() ? spent.cpu : spent.wall);
    }
    gl.glBindBuffer(GL_COPY_READ_BUFFER, 0);
    gl.glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    if (readBack<float>(gl, to.buffer(), 1).front() != 1.5f) throw std::runtime_error("a copy is not there");
    from.release();
    to.release();
    requireNoGlErrors();
    return 2.0 * static_cast<double>(bytes) / figureOf(seconds).median;
}

namespace
{

constexpr std::size_t entries = texelsOfLayout / POSE_TEXELS_PER_MATRIX;
constexpr std::size_t vertices = 96; ///< of an instance

// Vertices side by side read the same entries. All triangles are outside of the picture.
constexpr const char* readerShader = R"(
uniform samplerBuffer palette;
uniform int instances;
layout(location = 0) in uvec4 drawn;
out vec4 place;
mat3x4 entryOf(int entry)
{
    int texel = 3 * (isInstanceMajor ? int(drawn.x) * entryCount + entry : entry * instances + int(drawn.x));
    return mat3x4(texelFetch(palette, texel), texelFetch(palette, texel + 1), texelFetch(palette, texel + 2));
}
void main()
{
    vec4 vertex = vec4(gl_VertexID % 7, gl_VertexID % 5, 1.0, 1.0);
    place = vec4(0.0);
    for (int influence = 0; influence < 4; ++influence)
        place += 0.25 * vec4(vertex * entryOf((gl_VertexID / 2 + influence) % entryCount), 1.0);
    gl_Position = vec4(4.0 + fract(dot(place, vec4(0.001))), 0.0, 0.0, 1.0);
}
)";

/// A program of the reader that draws.
GLuint drawingProgram(osg::GLExtensions& gl, const std::string& source)
{
    const GLuint program = gl.glCreateProgram();
    const auto add = [&](GLenum type, const std::string& of)
    {
        const GLuint shader = gl.glCreateShader(type);
        const char* text = of.c_str();
        gl.glShaderSource(shader, 1, &text, nullptr);
        gl.glCompileShader(shader);
        gl.glAttachShader(program, shader);
        gl.glDeleteShader(shader);
    };
    add(GL_VERTEX_SHADER, "#version 330\n" + source);
    add(GL_FRAGMENT_SHADER, "#version 330\nin vec4 place; out vec4 color; void main() { color = place; }\n");
    gl.glLinkProgram(program);
    GLint isLinked = 0;
    gl.glGetProgramiv(program, GL_LINK_STATUS, &isLinked);
    if (isLinked == 0) throw std::runtime_error("a reader of palettes does not link");
    return program;
}

/// Instances of a crowd of four levels as a frame lists them: level by level, in each by rising index.
std::vector<glm::uvec4> levelByLevel(std::size_t instances)
{
    std::array<std::vector<glm::uvec4>, 4> levels;
    std::mt19937 random(3);
    for (std::size_t i = 0; i < instances; ++i)
        levels[random() % levels.size()].emplace_back(static_cast<unsigned int>(i), 0, 0, 0);
    for (std::size_t level = 1; level < levels.size(); ++level)
        levels[0].insert(levels[0].end(), levels[level].begin(), levels[level].end());
    return levels[0];
}

/// A layout of the palettes of all instances, and the programs that read it.
struct Layout
{
    Layout(osg::GLExtensions& gl, bool isInstanceMajor, std::size_t instances)
        : source("const int entryCount = " + std::to_string(entries) +
                 ";\nconst bool isInstanceMajor = " + (isInstanceMajor ? "true;\n" : "false;\n") + readerShader),
          check(gl, "reader", {source.c_str()}, {"place"}), program(drawingProgram(gl, source)),
          palette(gl, GL_RGBA32F_ARB)
    {
        std::vector<AffineMatrix> matrices(entries * instances);
        for (std::size_t entry = 0; entry < entries; ++entry)
            for (std::size_t i = 0; i < instances; ++i)
            {
                AffineMatrix& matrix = matrices[isInstanceMajor ? i * entries + entry : entry * instances + i];
                matrix.rows[0].w = static_cast<float>(i);
                matrix.rows[1].w = static_cast<float>(entry);
            }
        palette.upload(matrices.data(), matrices.size() * sizeof(AffineMatrix));
    }

    std::string source;
    FeedbackPass check;
    GLuint program;
    BufferTexture palette;
};

} // namespace

void measureLayouts(osg::State& state, std::size_t instances, GpuPage& page)
{
    osg::GLExtensions& gl = glOf(state);
    const VertexArray array(gl);
    Layout entryMajor(gl, false, instances), instanceMajor(gl, true, instances);
    BufferTexture list(gl, GL_RGBA32UI_EXT), out(gl, GL_RGBA32F_ARB);
    const std::size_t checked = std::min<std::size_t>(instances, 30);
    out.reserve(checked * vertices * sizeof(glm::vec4));
    std::vector<glm::uvec4> inOrder(instances);
    for (std::size_t i = 0; i < instances; ++i)
        inOrder[i].x = static_cast<unsigned int>(i);
    for (const auto& [what, order] :
         {std::pair("four entries a vertex, in order", inOrder), {"the same, level by level", levelByLevel(instances)}})
    {
        list.upload(order.data(), order.size() * sizeof(glm::uvec4));
        gl.glBindVertexArray(array.name);
        list.bindAttributes(0, 1, sizeof(glm::uvec4), 0, 1);
        gl.glBindVertexArray(0);
        const auto draw = [&](const Layout& layout)
        {
            state.bindVertexArrayObject(array.name);
            gl.glUseProgram(layout.program);
            gl.glUniform1i(gl.glGetUniformLocation(layout.program, "palette"), 0);
            gl.glUniform1i(gl.glGetUniformLocation(layout.program, "instances"), static_cast<GLint>(instances));
            bindBufferTexture(state, 0, layout.palette.texture());
            gl.glDrawArraysInstanced(GL_TRIANGLES, 0, vertices, static_cast<GLsizei>(instances));
            bindBufferTexture(state, 0, 0);
            gl.glUseProgram(0);
            state.unbindVertexArrayObject();
        };
        std::vector<std::vector<glm::vec4>> results;
        for (Layout* layout : {&entryMajor, &instanceMajor})
        {
            FeedbackScope scope(state, array.name);
            layout->check.use();
            layout->check.setInt("instances", static_cast<int>(instances));
            layout->check.setTexture(scope, "palette", 0, layout->palette.texture());
            layout->check.runInstanced(vertices, checked, 0, out.buffer(), 0);
            results.push_back(readBack<glm::vec4>(gl, out.buffer(), checked * vertices));
        }
        if (results[0] != results[1] || results[0][vertices].x == 0.0f)
            throw std::runtime_error("the layouts of palettes give different vertices");
        page.race(what, instances,
                  {{"entry-major", [&] { draw(entryMajor); }}, {"instance-major", [&] { draw(instanceMajor); }}},
                  static_cast<double>(instances * (entries * sizeof(AffineMatrix) + sizeof(glm::uvec4))));
    }
    for (Layout* layout : {&entryMajor, &instanceMajor})
    {
        layout->check.release();
        layout->palette.release();
        gl.glDeleteProgram(layout->program);
    }
    list.release();
    out.release();
    requireNoGlErrors();
}

namespace
{

/// A buffer that stays mapped, of which the GPU reads one part while the CPU writes another.
class MappedRing
{
public:
    MappedRing(osg::GLExtensions& gl, std::size_t bytes) : _gl(gl), _bytes(bytes)
    {
        constexpr GLbitfield flags = 0x0002 | 0x0040 | 0x0080; // write, persistent, coherent
        const auto size = static_cast<GLsizeiptr>(parts * bytes);
        _gl.glGenBuffers(1, &_buffer);
        _gl.glBindBuffer(GL_ARRAY_BUFFER, _buffer);
        _gl.glBufferStorage(GL_ARRAY_BUFFER, size, nullptr, flags);
        _mapped = static_cast<char*>(_gl.glMapBufferRange(GL_ARRAY_BUFFER, 0, size, flags));
        _gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
        if (!_mapped) throw std::runtime_error("a buffer cannot be mapped");
    }
    ~MappedRing()
    {
        for (const GLsync fence : _fences)
            if (fence) _gl.glDeleteSync(fence);
        _gl.glDeleteBuffers(1, &_buffer);
    }
    MappedRing(const MappedRing&) = delete;
    MappedRing& operator=(const MappedRing&) = delete;

    static bool isThere(const osg::GLExtensions& gl)
    {
        return osg::isGLExtensionOrVersionSupported(gl.contextID, "GL_ARB_buffer_storage", 4.4f) &&
               gl.glBufferStorage && gl.glFenceSync;
    }

    /// Writes the next part and binds it as attribute 0.
    void write(const void* data)
    {
        _part = (_part + 1) % parts;
        if (GLsync& fence = _fences[_part]; fence)
        {
            constexpr GLbitfield flush = 1;
            constexpr GLuint64 second = 1000000000;
            _gl.glClientWaitSync(fence, flush, second);
            _gl.glDeleteSync(fence);
            fence = nullptr;
        }
        std::memcpy(_mapped + _part * _bytes, data, _bytes);
        _gl.glBindBuffer(GL_ARRAY_BUFFER, _buffer);
        _gl.glVertexAttribIPointer(0, 4, GL_UNSIGNED_INT, 0, reinterpret_cast<const GLvoid*>(_part * _bytes));
        _gl.glEnableVertexAttribArray(0);
        _gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
    }
    /// After the draw that reads the part.
    void used() { _fences[_part] = _gl.glFenceSync(0x9117, 0); } // the GPU's commands are complete

private:
    static constexpr std::size_t parts = 3;

    osg::GLExtensions& _gl;
    std::size_t _bytes;
    GLuint _buffer = 0;
    char* _mapped = nullptr;
    std::array<GLsync, parts> _fences{};
    std::size_t _part = 0;
};

constexpr const char* samplesShader = R"(
layout(location = 0) in uvec4 given;
out vec4 row0;
out vec4 row1;
out vec4 row2;
void main()
{
    row0 = row1 = row2 = vec4(given);
}
)";

} // namespace

void measureUploads(osg::State& state, std::size_t instances, GpuPage& page)
{
    osg::GLExtensions& gl = glOf(state);
    const VertexArray array(gl);
    FeedbackPass pass(gl, "samples", {samplesShader}, {"row0", "row1", "row2"});
    BufferTexture live(gl, GL_RGBA32UI_EXT), renewed(gl, GL_RGBA32UI_EXT), out(gl, GL_RGBA32F_ARB);
    out.reserve(instances * sizeof(AffineMatrix));
    std::vector<glm::uvec4> content(instances, glm::uvec4(0));
    const std::size_t bytes = instances * sizeof(glm::uvec4);
    live.upload(content.data(), bytes);
    renewed.upload(content.data(), bytes);
    const auto step = [&](const std::function<void()>& upload, const BufferTexture* bound)
    {
        content.front().x = content.back().x = content.back().x % 1000 + 1;
        const FeedbackScope scope(state, array.name);
        upload();
        if (bound) bound->bindAttributes(0, 1, sizeof(glm::uvec4), 0, 0);
        pass.use();
        pass.run(0, instances, out.buffer(), 0);
    };
    std::unique_ptr<MappedRing> ring;
    std::vector<Variant> variants{
        {"into the live buffer", [&] { step([&] { live.uploadPart(0, content.data(), bytes); }, &live); }},
        {"into new storage", [&] { step([&] { renewed.upload(content.data(), bytes); }, &renewed); }}};
    if (MappedRing::isThere(gl))
    {
        ring = std::make_unique<MappedRing>(gl, bytes);
        variants.push_back({"mapped ring of three", [&]
                            {
                                step([&] { ring->write(content.data()); }, nullptr);
                                ring->used();
                            }});
    }
    for (const Variant& variant : variants)
    {
        variant.step();
        const auto written = readBack<glm::vec4>(gl, out.buffer(), 3 * instances);
        const auto last = static_cast<float>(content.back().x);
        if (written.front().x != last || written.back().x != last)
            throw std::runtime_error("an upload " + variant.name + " is not there");
    }
    page.race("16 bytes an instance uploaded and read", instances, variants,
              static_cast<double>(instances * (3 * sizeof(glm::uvec4) + sizeof(AffineMatrix))));
    ring.reset();
    pass.release();
    for (BufferTexture* buffer : {&live, &renewed, &out})
        buffer->release();
    requireNoGlErrors();
}

} // namespace osgGpuAnimation::benchmark
