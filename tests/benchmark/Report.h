// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// Elapsed seconds: CPU time of the whole process on all processors, wall-clock time and, where a GpuClock measures,
/// the GPU's time.
struct Spent
{
    double cpu = 0.0;
    double wall = 0.0;
    double gpu = 0.0;

    Spent operator+(const Spent& other) const { return {cpu + other.cpu, wall + other.wall, gpu + other.gpu}; }
    Spent operator/(double count) const { return {cpu / count, wall / count, gpu / count}; }
    Spent with(double gpuSeconds) const { return {cpu, wall, gpuSeconds}; }
};

/// Measures from its construction on.
class Stopwatch
{
public:
    Stopwatch();
    Spent elapsed() const;

private:
    Spent _start;
};

/// The median of several rounds and its quartiles.
struct Figure
{
    double median = 0.0;
    double low = 0.0;
    double high = 0.0;
};

Figure figureOf(std::vector<double> values);
Figure figureOf(double value); ///< Of a single round.

/// The cost of one contestant per round.
using Series = std::vector<Spent>;

/// The CPU or wall-clock times, multiplied by the scale.
Figure figureOf(const Series& series, double scale = 1.0, double Spent::*clock = &Spent::cpu);
/// The quotient of the CPU times, round by round: slowdowns that affect both contestants cancel out.
Figure ratioOf(const Series& dividend, const Series& divisor);

/// Runs the contestants in turns, once unmeasured and then `rounds` times; returns one series per contestant.
std::vector<Series> interleaved(int rounds, const std::vector<std::function<Spent()>>& contestants);

/// Two or three digits, or as many as the number has before the point.
std::string digits(double value);

/// A row of the table: our figure, alone or against another contestant's, and perhaps a limit:
///
///     report.add(Row(subject, 1000, "skinned draw", "µs a character", ours, 1e3).against("unskinned",
///     other).atMost(1.6));
struct Row
{
    std::string subject;
    std::size_t count; ///< characters
    std::string what;
    std::string unit; ///< of ours and other, such as `µs a joint`
    Figure ours;
    std::string otherName; ///< empty if there is none
    Figure other;
    Figure ratio;      ///< of CPU times
    std::string bar;   ///< empty: none
    bool isMet = true; ///< true if the ratio (ours, if there is none) is within the bar

    Row(std::string subject, std::size_t count, std::string what, std::string unit, Figure ours);
    /// scale: the factor from CPU seconds to the unit.
    Row(std::string subject, std::size_t count, std::string what, std::string unit, Series ours, double scale);

    Row& against(const std::string& name, const Series& theirs);    ///< The ratio is ours / theirs.
    Row& fasterThan(const std::string& name, const Series& theirs); ///< The ratio is theirs / ours.
    Row& atMost(double limit);
    Row& atLeast(double limit);

private:
    double barred() const { return otherName.empty() ? ours.median : ratio.median; }

    Series _ours;
    double _scale = 1.0;
};

/// Collects the results and writes them as a table and as JSON.
class Report
{
public:
    void add(Row row) { _rows.push_back(std::move(row)); }

    void printTable(std::ostream& out) const; ///< Markdown
    /// environment: names and values that are written with the figures. False: a file cannot be written.
    bool write(const std::string& folder, const std::map<std::string, std::string>& environment) const;

private:
    std::vector<Row> _rows;
};

} // namespace osgGpuAnimation::benchmark
