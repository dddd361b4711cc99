// SPDX-License-Identifier: MIT
#pragma once

#include "Plot.h"
#include "Series.h"

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// A line of the table: two contestants, or one and a limit.
struct Row
{
    std::string subject;
    std::size_t count = 0; ///< characters
    std::string what;
    std::string unit;      ///< of ours and other: a joint, a character …
    Figure ours;           ///< CPU time, unless the unit says otherwise
    std::string otherName; ///< empty: there is no other
    Figure other;
    Figure ratio; ///< CPU time; what the bar speaks of
    Figure wallRatio;
    std::string bar;   ///< empty: none
    bool isMet = true; ///< is the ratio (or ours) within the bar?
};

/// What has been measured, and how it is told.
class Report
{
public:
    void add(Row row);
    void addPoint(const std::string& plot, const std::string& line, double x, double y);
    void describePlot(const std::string& plot, const std::string& title, const std::string& xTitle,
                      const std::string& yTitle);

    void printTable(std::ostream& out) const; ///< Markdown
    /// environment: names and values to write down with the figures. Error: a file cannot be written.
    bool write(const std::string& folder, const std::map<std::string, std::string>& environment) const;

private:
    std::vector<Row> _rows;
    std::map<std::string, Plot> _plots; ///< by file name
};

/// A row of two contestants. scale: what CPU seconds are multiplied by to come to the unit.
/// The ratio is other by ours where isSpeedup, else ours by other.
Row compared(const Series& ours, const Series& other, double scale, bool isSpeedup);

} // namespace osgGpuAnimation::benchmark
