// SPDX-License-Identifier: MIT
#pragma once

#include "Series.h"

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

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
