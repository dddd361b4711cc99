// SPDX-License-Identifier: MIT
// Usage: soak [--seconds N] [--seed S] [--field COUNT] FILE
// With the file's character, clones, removes, changes clips, moves the cameras, changes the window's size and the
// threading model: at random, but the same for the same seed. A field is a crowd of that many instances with levels of
// detail, of which every frame replaces, moves and redirects 1 %. Prints GL errors and the growth of allocated memory
// since the first minute, measured with the window closed and the scene empty but for the field. Exit status 0: no GL
// error, and at most 2 % growth.

#include "SoakScene.h"
#include "SoakViewer.h"

#include <osgDB/ReadFile>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <malloc.h>
#include <numeric>
#include <string>
#include <vector>

namespace
{

using namespace osgGpuAnimation;

struct Arguments
{
    double seconds = 600.0;
    unsigned int seed = 1;
    std::size_t field = 0; ///< instances
    std::string file;
};

bool parse(int count, char** words, Arguments& arguments)
{
    for (int i = 1; i < count; ++i)
    {
        const bool hasValue = i + 1 < count;
        if (std::strcmp(words[i], "--seconds") == 0 && hasValue)
            arguments.seconds = std::atof(words[++i]);
        else if (std::strcmp(words[i], "--seed") == 0 && hasValue)
            arguments.seed = static_cast<unsigned int>(std::atoi(words[++i]));
        else if (std::strcmp(words[i], "--field") == 0 && hasValue)
            arguments.field = static_cast<std::size_t>(std::max(0, std::atoi(words[++i])));
        else if (words[i][0] != '-' && arguments.file.empty())
            arguments.file = words[i];
        else
            return false;
    }
    return !arguments.file.empty() && arguments.seconds > 0.0 && arguments.field <= AnimatedCrowd::maxInstances;
}

/// Bytes that are allocated and not freed. Resident memory is less precise: it is twenty times as large, mostly
/// libraries, and varies by a tenth with the memory that malloc keeps for ended threads. With an open window llvmpipe's
/// lists of triangles would dominate and vary likewise.
std::size_t allocatedBytes()
{
    const struct mallinfo2 all = mallinfo2();
    return all.uordblks + all.hblkhd;
}

/// Resident memory in KiB after malloc_trim(). It is printed, but not checked.
long residentMemory()
{
    malloc_trim(0);
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("VmRSS:", 0) == 0) return std::atol(line.c_str() + 6);
    return 0;
}

/// 0 if there are no values. Not the median: memory at rest with a field varies by some 5 % from window to window.
double mean(const std::vector<std::size_t>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(1, values.size()));
}

class Clock
{
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - _start).count(); }

private:
    std::chrono::steady_clock::time_point _start = std::chrono::steady_clock::now();
};

void changeViewer(SoakViewer& viewer, unsigned int frame, std::mt19937& random)
{
    if (frame % 7 == 0) viewer.moveCamera(random);
    if (frame % 20 == 0) viewer.changeThreading(random);
}

int soak(const Arguments& arguments, osg::ref_ptr<osg::Node> model)
{
    std::mt19937 random(arguments.seed);
    SoakScene scene(model, arguments.field, random);
    const unsigned int framesOfAWindow = arguments.field > 10000 ? 20 : 200; // a field's take long
    SoakViewer viewer(scene.root());
    const Clock clock;
    const double warmUp = std::min(60.0, arguments.seconds / 3);
    std::vector<std::size_t> atRest, atRestAtFirst; // with the window closed and the scene empty but for the field
    unsigned int frame = 0;
    while (clock.seconds() < arguments.seconds)
    {
        scene.change(random);
        changeViewer(viewer, frame, random);
        viewer.frame(frame / 60.0);
        if (++frame % framesOfAWindow != 0) continue;
        viewer.settle(frame / 60.0);
        viewer.close();
        scene.clear();
        const double seconds = clock.seconds();
        const std::size_t bytes = allocatedBytes();
        (seconds < warmUp ? atRestAtFirst : atRest).push_back(bytes);
        std::cout << static_cast<int>(seconds) << " s, " << frame << " frames, " << bytes << " bytes at rest, "
                  << residentMemory() << " KiB resident, " << viewer.glErrors() << " GL errors" << std::endl;
        if (!viewer.open(random)) return 1;
    }
    const double before = mean(atRestAtFirst), after = mean(atRest);
    const double growth = before > 0.0 ? 100.0 * (after - before) / before : 100.0;
    std::cout << frame << " frames, " << viewer.glErrors() << " GL errors, mean memory at rest in the first "
              << static_cast<int>(warmUp) << " s " << before << " bytes, afterwards " << after << " bytes: " << growth
              << " %" << std::endl;
    return viewer.glErrors() == 0 && growth <= 2.0 ? 0 : 1;
}

} // namespace

int main(int count, char** words)
{
    Arguments arguments;
    if (!parse(count, words, arguments))
    {
        std::cerr << "Usage: soak [--seconds N] [--seed S] [--field COUNT] FILE" << std::endl;
        return 2;
    }
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(arguments.file);
    if (!model || !findCharacter(*model))
    {
        std::cerr << arguments.file << " holds no animated character" << std::endl;
        return 2;
    }
    return soak(arguments, model);
}
