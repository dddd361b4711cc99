// SPDX-License-Identifier: MIT
#include "Measurements.h"

#include <osgGpuAnimation/gpu/OffscreenContext.h>

#include <osg/ArgumentParser>
#include <osg/Notify>

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <thread>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr const char* usage = R"(osggpuanim_benchmark [options] OUTPUT_FOLDER FILE...
    measures this kit against osgAnimation with the characters of glTF files, prints a table and writes benchmark.json
    into the folder
    --quick           fewer characters and rounds
    --only PART       one of the parts below (gpu writes gpu.md and gpu.json: the choices that a GPU decides); several times, too
    --return-memory   leave it to glibc whether freed memory goes back to the kernel
Parts: )";

struct Request
{
    std::string folder;
    bool isQuick = false;
    bool returnsMemory = false;
    std::set<std::string> parts; ///< empty: all
    std::vector<std::string> files;

    bool has(const std::string& part) const { return parts.empty() || parts.count(part) != 0; }
};

constexpr std::pair<const char*, void (*)(const Subject&, Run&)> parts[] = {
    {"samples", measureSamples},   {"constraints", measureConstraints},
    {"chunks", measureChunks},     {"compact", measureCompact},
    {"pose", measurePose},         {"frames", measureFrames},
    {"crowd", measureCrowd},       {"outfits", measureOutfits},
    {"separate", measureSeparate}, {"field", measureField},
    {"draws", measureDraws},       {"pictures", measurePictures},
    {"shading", measureShading},   {"start", measureStart},
    {"memory", measureMemory},     {"load", measureLoad}};

std::vector<std::string> partNames()
{
    std::vector<std::string> names{"depth", "mixed", "gpu"}; // of no one file
    for (const auto& [name, function] : parts)
        names.push_back(name);
    return names;
}

/// Says which of the parts of --only do not exist.
bool checkParts(const Request& request)
{
    const std::vector<std::string> known = partNames();
    for (const std::string& part : request.parts)
        if (std::find(known.begin(), known.end(), part) == known.end())
        {
            std::cerr << "there is no part \"" << part << "\"; the parts are " << quotedNames(known) << std::endl;
            return false;
        }
    return true;
}

bool parse(int count, char** words, Request& request)
{
    osg::ArgumentParser parser(&count, words);
    request.isQuick = parser.read("--quick");
    request.returnsMemory = parser.read("--return-memory");
    for (std::string part; parser.read("--only", part);)
        request.parts.insert(part);
    if (parser.containsOptions() || parser.argc() < 3) return false;
    if (!checkParts(request)) return false;
    request.folder = parser[1];
    request.files.assign(words + 2, words + parser.argc());
    return true;
}

/// Records OSG's messages and passes them on to standard error. Figures are invalid if a program did not link (OSG
/// prints a notice) or a GL error occurred (OSG prints it and clears glGetError).
struct WarningWatch : osg::NotifyHandler
{
    void notify(osg::NotifySeverity severity, const char* message) override
    {
        std::cerr << message << std::flush;
        if (severity <= osg::NOTICE) warnings += message;
    }
    std::string warnings;
};

std::vector<Subject> loadSubjects(const std::vector<std::string>& files)
{
    std::vector<Subject> subjects;
    for (const std::string& file : files)
    {
        Result<Subject> subject = loadSubject(file, true);
        if (subject)
            subjects.push_back(std::move(subject).value());
        else
            std::cerr << file << ": " << subject.error().message << ", left out" << std::endl;
    }
    if (subjects.empty()) throw std::runtime_error("no file holds an animated character");
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

void measureAll(const Request& request, Run& run)
{
    const auto measure = [&](const char* part, const std::string& subject, const auto& function)
    {
        if (!request.has(part)) return;
        std::cerr << subject << ": " << part << std::endl;
        run.context.makeCurrent();
        function();
    };
    const osg::ref_ptr<WarningWatch> watch = new WarningWatch;
    osg::setNotifyHandler(watch);
    measure("depth", "chains", [&] { measureDepth(run); });
    const std::vector<Subject> subjects = loadSubjects(request.files);
    for (const Subject& subject : subjects)
        for (const auto& [part, function] : parts)
            measure(part, subject.name, [&, function = function] { function(subject, run); });
    measure("mixed", "all", [&] { measureMixed(subjects, run); });
    measure("gpu", "all", [&] { measureGpu(subjects, run); });
    run.context.makeCurrent();
    requireNoGlErrors();
    if (!watch->warnings.empty()) throw std::runtime_error("OSG says: " + watch->warnings);
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
    const osg::ref_ptr<osg::GraphicsContext> context = taken(createOffscreenContext(64, 64));
    if (!context->realize() || !context->makeCurrent()) throw std::runtime_error("the GL context does not realize");
    const std::map<std::string, std::string> machine = describeMachine();
    Report report;
    Run run{*context, report, request.folder};
    if (request.isQuick) run.beQuick();
    measureAll(request, run);
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
    if (!parse(count, words, request))
    {
        std::cerr << usage << osgGpuAnimation::quotedNames(partNames()) << std::endl;
        return 2;
    }
    try
    {
        return run(request);
    }
    catch (const std::exception& error)
    {
        std::cerr << "no report: " << error.what() << std::endl;
        return 1;
    }
}
