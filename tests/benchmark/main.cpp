// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "StagedViewer.h"
#include "WarningWatch.h"

#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

#include <malloc.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <thread>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr const char* usage = R"(osggpuanim_benchmark [options] OUTPUT_FOLDER FILE...
    measures this kit against osgAnimation with the characters of glTF files, prints a table and writes benchmark.json
    and plots into the folder
    --quick           fewer characters and rounds
    --only PART       pose, samples, constraints, chunks, compact, depth, frames, crowd, field, mixed, pictures, draws,
                      shading, start, memory or load; several times, too
    --return-memory   leave it to glibc whether freed memory goes back to the kernel
)";

struct Request
{
    std::string folder;
    bool isQuick = false;
    bool returnsMemory = false;
    std::set<std::string> parts; ///< empty: all
    std::vector<std::string> files;

    bool has(const std::string& part) const { return parts.empty() || parts.count(part) != 0; }
};

bool parse(int count, char** words, Request& request)
{
    for (int i = 1; i < count; ++i)
    {
        const std::string word = words[i];
        const bool hasValue = i + 1 < count;
        if (word == "--quick")
            request.isQuick = true;
        else if (word == "--return-memory")
            request.returnsMemory = true;
        else if (word == "--only" && hasValue)
            request.parts.insert(words[++i]);
        else if (word.rfind("--", 0) == 0)
            return false;
        else if (request.folder.empty())
            request.folder = word;
        else
            request.files.push_back(word);
    }
    return !request.files.empty();
}

std::vector<Subject> loadSubjects(const Request& request)
{
    std::vector<Subject> subjects;
    for (const std::string& file : request.files)
    {
        const std::string name = std::filesystem::path(file).stem().string();
        Result<Subject> subject = loadSubject(name, file, true);
        if (!subject)
        {
            std::cerr << file << ": " << subject.error().message << ", left out" << std::endl;
            continue;
        }
        std::cerr << name << ": " << subject.value().jointCount() << " joints, " << subject.value().set().paletteSize()
                  << " palette entries, " << subject.value().set().levelCount() << " levels, "
                  << subject.value().vertexCount() << " vertices, clip "
                  << subject.value().set().clips()[subject.value().clip].name() << std::endl;
        subjects.push_back(std::move(subject.value()));
    }
    return subjects;
}

std::map<std::string, std::string> describeMachine()
{
    std::map<std::string, std::string> machine;
    std::ifstream cpuInfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuInfo, line);)
        if (line.rfind("model name", 0) == 0) machine["processor"] = line.substr(line.find(':') + 2);
    machine["cores"] = std::to_string(std::thread::hardware_concurrency());
    machine["GL vendor"] = reinterpret_cast<const char*>(glGetString(GL_VENDOR));
    machine["GL renderer"] = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    machine["GL version"] = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    machine["compiler"] = __VERSION__;
    machine["times"] = "CPU time of the process on all cores, unless they say wall";
    return machine;
}

Result<void> measureSubject(const Request& request, const Effort& effort, const Subject& subject,
                            osg::GraphicsContext& context, Report& report)
{
    const std::pair<const char*, Result<void> (*)(const Subject&, const Effort&, Report&)> inViewers[] = {
        {"frames", measureFrames}, {"crowd", measureCrowd},       {"field", measureField},
        {"draws", measureDraws},   {"pictures", measurePictures}, {"shading", measureShading},
        {"start", measureStart},   {"memory", measureMemory},     {"load", measureLoad}};
    if (request.has("samples"))
        if (Result<void> done = measureSamples(subject, effort, context, report); !done) return done;
    if (request.has("constraints"))
        if (Result<void> done = measureConstraints(subject, effort, context, report); !done) return done;
    if (request.has("chunks"))
        if (Result<void> done = measureChunks(subject, effort, context, report); !done) return done;
    if (request.has("compact"))
        if (Result<void> done = measureCompact(subject, effort, context, report); !done) return done;
    if (request.has("pose"))
        if (Result<void> done = measurePose(subject, effort, context, report); !done) return done;
    context.releaseContext();
    for (const auto& [part, measure] : inViewers)
        if (request.has(part))
            if (Result<void> done = measure(subject, effort, report); !done) return done;
    context.makeCurrent();
    return {};
}

Result<void> measureAll(const Request& request, osg::GraphicsContext& context, Report& report)
{
    const osg::ref_ptr<WarningWatch> watch = new WarningWatch;
    osg::setNotifyHandler(watch);
    const Effort effort = request.isQuick ? Effort::quick() : Effort();
    if (request.has("depth"))
        if (Result<void> done = measureDepth(effort, context, report); !done) return done;
    const std::vector<Subject> subjects = loadSubjects(request);
    if (subjects.empty()) return Error{"no file holds an animated character"};
    for (const Subject& subject : subjects)
        if (Result<void> done = measureSubject(request, effort, subject, context, report); !done)
            return Error{subject.name + ": " + done.error().message};
    context.releaseContext();
    if (request.has("mixed"))
        if (Result<void> done = measureMixed(subjects, effort, report); !done) return done;
    context.makeCurrent();
    if (const std::string errors = takeGlErrors(); !errors.empty()) return Error{"GL reports " + errors};
    if (!watch->warnings().empty()) return Error{"OSG says: " + watch->warnings()};
    return {};
}

/// Keeps freed memory in the process. By default glibc may return the memory of llvmpipe's draws to the kernel and
/// fault it in again page by page. This varies from run to run and changes frame times by up to a fifth, osgAnimation's
/// too.
void keepFreedMemory()
{
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 2000000000);
    mallopt(M_TOP_PAD, 1 << 24);
}

int run(const Request& request)
{
    if (!request.returnsMemory) keepFreedMemory();
    const Result<osg::ref_ptr<EglGraphicsContext>> context = EglGraphicsContext::create(64, 64);
    if (!context || !context.value()->realize() || !context.value()->makeCurrent())
    {
        std::cerr << "no GL: " << (context ? "the context does not realize" : context.error().message) << std::endl;
        return 1;
    }
    const std::map<std::string, std::string> machine = describeMachine();
    Report report;
    if (const Result<void> done = measureAll(request, *context.value(), report); !done)
    {
        std::cerr << "no report, since a result is wrong: " << done.error().message << std::endl;
        return 1;
    }
    for (const auto& [name, value] : machine)
        std::cout << name << ": " << value << "\n";
    std::cout << "\n";
    report.printTable(std::cout);
    if (report.write(request.folder, machine)) return 0;
    std::cerr << "cannot write into " << request.folder << std::endl;
    return 1;
}

} // namespace

} // namespace osgGpuAnimation::benchmark

int main(int count, char** words)
{
    using namespace osgGpuAnimation::benchmark;
    Request request;
    if (parse(count, words, request)) return run(request);
    std::cerr << usage;
    return 2;
}
