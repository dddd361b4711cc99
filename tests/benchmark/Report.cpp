// SPDX-License-Identifier: MIT
#include "Report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace osgGpuAnimation::benchmark
{

namespace
{

double now(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

Stopwatch::Stopwatch() : _start{now(CLOCK_PROCESS_CPUTIME_ID), now(CLOCK_MONOTONIC), 0.0} {}

Spent Stopwatch::elapsed() const
{
    return {now(CLOCK_PROCESS_CPUTIME_ID) - _start.cpu, now(CLOCK_MONOTONIC) - _start.wall, 0.0};
}

Figure figureOf(std::vector<double> values)
{
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t last = values.size() - 1;
    const double median = 0.5 * (values[last / 2] + values[values.size() / 2]);
    return {median, values[last / 4], values[last - last / 4]};
}

Figure figureOf(double value)
{
    return {value, value, value};
}

Figure figureOf(const Series& series, double scale, double Spent::*clock)
{
    std::vector<double> values;
    for (const Spent& spent : series)
        values.push_back(scale * (spent.*clock));
    return figureOf(std::move(values));
}

Figure ratioOf(const Series& dividend, const Series& divisor)
{
    std::vector<double> values;
    for (std::size_t round = 0; round < std::min(dividend.size(), divisor.size()); ++round)
        if (divisor[round].cpu > 0.0) values.push_back(dividend[round].cpu / divisor[round].cpu);
    return figureOf(std::move(values));
}

std::vector<Series> interleaved(int rounds, const std::vector<std::function<Spent()>>& contestants)
{
    std::vector<Series> series(contestants.size());
    for (int round = -1; round < rounds; ++round)
        for (std::size_t i = 0; i < contestants.size(); ++i)
        {
            const Spent spent = contestants[i]();
            if (round >= 0) series[i].push_back(spent);
        }
    return series;
}

std::string digits(double value)
{
    std::ostringstream text;
    if (value != 0.0 && value < 0.1)
        text << std::setprecision(2) << value;
    else
        text << std::fixed << std::setprecision(value < 10.0 ? 2 : value < 100.0 ? 1 : 0) << value;
    return text.str();
}

namespace
{

std::string text(const Figure& figure)
{
    return digits(figure.median) + " (" + digits(figure.low) + " – " + digits(figure.high) + ")";
}

std::string text(const char* comparison, double limit)
{
    std::ostringstream bar;
    bar << comparison << " " << limit;
    return bar.str();
}

nlohmann::json json(const Figure& figure)
{
    return {{"median", figure.median}, {"lowerQuartile", figure.low}, {"upperQuartile", figure.high}};
}

nlohmann::json json(const Row& row)
{
    nlohmann::json out{{"subject", row.subject},
                       {"characters", row.count},
                       {"what", row.what},
                       {"unit", row.unit},
                       {"ours", json(row.ours)}};
    if (!row.otherName.empty())
        out.update({{"otherName", row.otherName}, {"other", json(row.other)}, {"cpuRatio", json(row.ratio)}});
    if (!row.bar.empty()) out["bar"] = {{"text", row.bar}, {"met", row.isMet}};
    return out;
}

} // namespace

Row::Row(std::string subject, std::size_t count, std::string what, std::string unit, Figure ours)
    : subject(std::move(subject)), count(count), what(std::move(what)), unit(std::move(unit)), ours(ours)
{
}

Row::Row(std::string subject, std::size_t count, std::string what, std::string unit, Series ours, double scale)
    : Row(std::move(subject), count, std::move(what), std::move(unit), figureOf(ours, scale))
{
    _ours = std::move(ours);
    _scale = scale;
}

Row& Row::against(const std::string& name, const Series& theirs)
{
    otherName = name;
    other = figureOf(theirs, _scale);
    ratio = ratioOf(_ours, theirs);
    return *this;
}

Row& Row::fasterThan(const std::string& name, const Series& theirs)
{
    against(name, theirs);
    ratio = ratioOf(theirs, _ours);
    return *this;
}

Row& Row::atMost(double limit)
{
    bar = text("≤", limit);
    isMet = barred() <= limit;
    return *this;
}

Row& Row::atLeast(double limit)
{
    bar = text("≥", limit);
    isMet = barred() >= limit;
    return *this;
}

void Report::printTable(std::ostream& out) const
{
    if (_rows.empty()) return;
    out << "| what | subject | N | ours | against | theirs | ratio, CPU | bar |\n"
        << "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Row& row : _rows)
    {
        out << "| " << row.what << " | " << row.subject << " | " << row.count << " | " << text(row.ours) << " "
            << row.unit << " | ";
        if (row.otherName.empty())
            out << "– | – | –";
        else
            out << row.otherName << " | " << text(row.other) << " | " << text(row.ratio);
        out << " | " << (row.bar.empty() ? "–" : row.bar + (row.isMet ? ": met" : ": **missed**")) << " |\n";
    }
}

bool Report::write(const std::string& folder, const std::map<std::string, std::string>& environment) const
{
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    nlohmann::json document{{"environment", environment}, {"rows", nlohmann::json::array()}};
    for (const Row& row : _rows)
        document["rows"].push_back(json(row));
    std::ofstream file(folder + "/benchmark.json");
    file << document.dump(1) << "\n";
    return static_cast<bool>(file.flush());
}

} // namespace osgGpuAnimation::benchmark
