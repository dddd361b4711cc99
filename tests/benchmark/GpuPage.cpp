// SPDX-License-Identifier: MIT
#include "GpuPage.h"

#include "Report.h"

#include <osgGpuAnimation/gpu/detail/Renderer.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>

namespace osgGpuAnimation::benchmark
{

namespace
{

std::string orDash(double value)
{
    return value > 0.0 ? digits(value) : "–";
}

constexpr double microseconds = 1e6;

} // namespace

GpuPage::GpuPage(osg::State& state, int rounds, double seconds)
    : _state(state), _deciding(isSoftwareRenderer() ? &Line::cpu : &Line::wall), _rounds(rounds), _seconds(seconds)
{
}

void GpuPage::race(const std::string& what, std::size_t count, const std::vector<Variant>& variants, double bytes)
{
    GpuClock clock(_state);
    std::vector<std::function<Spent()>> contestants;
    std::vector<std::string> names;
    for (const Variant& variant : variants)
    {
        names.push_back(variant.name);
        inARow(2, clock, variant.step); // compiles and allocates
        const double once = std::max(inARow(1, clock, variant.step).wall, 1e-7);
        const auto steps = static_cast<std::size_t>(std::clamp(_seconds / _rounds / once, 1.0, 200.0));
        contestants.emplace_back([&clock, &variant, steps] { return inARow(steps, clock, variant.step); });
    }
    add(what, count, names, interleaved(_rounds, contestants), bytes);
}

void GpuPage::add(const std::string& what, std::size_t count, const std::vector<std::string>& names,
                  const std::vector<Series>& series, double bytes)
{
    const std::size_t first = _lines.size();
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        const auto figure = [&](double Spent::*clock) { return figureOf(series[i], microseconds, clock); };
        Line line{what, count, names[i], figure(&Spent::cpu), figure(&Spent::wall), figure(&Spent::gpu), 1.0, 0.0};
        const double time = (line.*_deciding).median;
        if (i > 0) line.ratio = time / (_lines[first].*_deciding).median;
        if (bytes > 0.0) line.speed = bytes * microseconds / (line.gpu.median > 0.0 ? line.gpu.median : time);
        _lines.push_back(line);
    }
}

void GpuPage::print(std::ostream& out) const
{
    for (const auto& [name, value] : environment)
        out << name << ": " << value << "\n";
    out << "\nMicroseconds of a step. Times the first: by "
        << (_deciding == &Line::cpu ? "CPU time, as this is a software renderer" : "the clock")
        << ". GB/s: of the memory that a step moves\n(gpu_costs.md), by the GPU's time if there is one; and in % of a "
           "copy's.\n\n"
        << "| what | N | variant | CPU | clock | GPU | times the first | GB/s | % |\n"
        << "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    const std::string* before = nullptr;
    for (const Line& line : _lines)
    {
        out << "| " << (before && *before == line.what ? "" : line.what) << " | " << line.count << " | " << line.variant
            << " | " << digits(line.cpu.median) << " | " << digits(line.wall.median) << " | " << orDash(line.gpu.median)
            << " | " << digits(line.ratio) << " | " << orDash(1e-9 * line.speed) << " | "
            << orDash(copySpeed > 0.0 ? 100.0 * line.speed / copySpeed : 0.0) << " |\n";
        before = &line.what;
    }
}

bool GpuPage::write(const std::string& folder) const
{
    const auto json = [](const Figure& figure) -> nlohmann::json {
        return {{"median", figure.median}, {"lowerQuartile", figure.low}, {"upperQuartile", figure.high}};
    };
    nlohmann::json document{
        {"environment", environment}, {"copyBytesPerSecond", copySpeed}, {"unit", "µs a step"}, {"lines", {}}};
    for (const Line& line : _lines)
        document["lines"].push_back({{"what", line.what},
                                     {"characters", line.count},
                                     {"variant", line.variant},
                                     {"cpu", json(line.cpu)},
                                     {"clock", json(line.wall)},
                                     {"gpu", json(line.gpu)},
                                     {"timesTheFirst", line.ratio},
                                     {"bytesPerSecond", line.speed}});
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    std::ofstream file(folder + "/gpu.json"), page(folder + "/gpu.md");
    file << document.dump(1) << "\n";
    print(page);
    return file.flush() && page.flush();
}

} // namespace osgGpuAnimation::benchmark
