// SPDX-License-Identifier: MIT
#include "Report.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace osgGpuAnimation::benchmark
{

namespace
{

std::string digits(double value)
{
    std::ostringstream text;
    if (value != 0.0 && value < 0.1)
        text << std::setprecision(2) << value;
    else
        text << std::fixed << std::setprecision(value < 10.0 ? 2 : value < 100.0 ? 1 : 0) << value;
    return text.str();
}

std::string text(const Figure& figure)
{
    return digits(figure.median) + " (" + digits(figure.low) + " – " + digits(figure.high) + ")";
}

Figure scaled(Figure figure, double scale)
{
    return {figure.median * scale, figure.low * scale, figure.high * scale};
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
    {
        out["otherName"] = row.otherName;
        out["other"] = json(row.other);
        out["cpuRatio"] = json(row.ratio);
        out["wallRatio"] = json(row.wallRatio);
    }
    if (!row.bar.empty()) out["bar"] = {{"text", row.bar}, {"met", row.isMet}};
    return out;
}

} // namespace

void Report::add(Row row)
{
    _rows.push_back(std::move(row));
}

void Report::addPoint(const std::string& plot, const std::string& line, double x, double y)
{
    _plots[plot].addPoint(line, x, y);
}

void Report::describePlot(const std::string& plot, const std::string& title, const std::string& xTitle,
                          const std::string& yTitle)
{
    _plots[plot].describe(title, xTitle, yTitle);
}

void Report::printTable(std::ostream& out) const
{
    out << "| what | subject | N | ours | against | theirs | ratio, CPU | ratio, wall | bar |\n"
        << "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Row& row : _rows)
    {
        const bool isCompared = !row.otherName.empty();
        out << "| " << row.what << " | " << row.subject << " | " << row.count << " | " << text(row.ours) << " "
            << row.unit << " | " << (isCompared ? row.otherName : "–") << " | " << (isCompared ? text(row.other) : "–")
            << " | " << (isCompared ? text(row.ratio) : "–") << " | "
            << (isCompared ? digits(row.wallRatio.median) : "–") << " | "
            << (row.bar.empty() ? "–" : row.bar + (row.isMet ? ": met" : ": **missed**")) << " |\n";
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
    bool isWritten = static_cast<bool>(file.flush());
    for (const auto& [name, plot] : _plots)
    {
        std::ofstream picture(folder + "/" + name);
        plot.write(picture);
        isWritten = isWritten && picture.flush();
    }
    return isWritten;
}

Row compared(const Series& ours, const Series& other, double scale, bool isSpeedup)
{
    Row row;
    row.ours = scaled(cpuOf(ours), scale);
    row.other = scaled(cpuOf(other), scale);
    row.ratio = isSpeedup ? cpuRatio(other, ours) : cpuRatio(ours, other);
    row.wallRatio = isSpeedup ? wallRatio(other, ours) : wallRatio(ours, other);
    return row;
}

} // namespace osgGpuAnimation::benchmark
