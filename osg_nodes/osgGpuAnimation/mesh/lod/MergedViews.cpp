// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/lod/MergedViews.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace osgGpuAnimation
{

namespace
{

using Seen = SurfaceViews::Seen;

constexpr int outlineSteps = 4; ///< for the outlines
constexpr int fittingSteps = 8; ///< for the colours
constexpr double fewSeen = 0.1; ///< of the cells that show a triangle: a side with no more is not visible

/// In [0, 1], of a white surface with a light at the viewer and a little everywhere.
float brightness(const glm::vec3& normal, const glm::vec3& towardsViewer)
{
    constexpr float everywhere = 0.2f;
    return everywhere + (1.0f - everywhere) * std::max(glm::dot(normal, towardsViewer), 0.0f);
}

float shadeOf(const osg::Vec4& color)
{
    return (color.r() + color.g() + color.b()) / 3.0f;
}

/// The means of a view's cells in square pixels. cells: across a pixel.
std::vector<double> pixelsOf(const std::vector<float>& view, double cells)
{
    const double across = std::max(cells, 1.0);
    const auto count = static_cast<std::size_t>(std::ceil(SurfaceViews::cellsAcross / across));
    std::vector<double> pixels(count * count);
    for (std::size_t cell = 0; cell < view.size(); ++cell)
    {
        const auto pixelAt = [&](std::size_t place)
        { return std::min(static_cast<std::size_t>(static_cast<double>(place) / across), count - 1); };
        const std::size_t x = cell % SurfaceViews::cellsAcross, y = cell / SurfaceViews::cellsAcross;
        pixels[pixelAt(y) * count + pixelAt(x)] += view[cell] / (across * across);
    }
    return pixels;
}

double structuralSimilarity(const std::vector<double>& a, const std::vector<double>& b)
{
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const auto count = static_cast<double>(a.size());
    const double meanA = std::accumulate(a.begin(), a.end(), 0.0) / count;
    const double meanB = std::accumulate(b.begin(), b.end(), 0.0) / count;
    const double squaresA = std::inner_product(a.begin(), a.end(), a.begin(), 0.0) / count;
    const double squaresB = std::inner_product(b.begin(), b.end(), b.begin(), 0.0) / count;
    const double products = std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / count;
    const double variances = squaresA - meanA * meanA + squaresB - meanB * meanB;
    return (2.0 * meanA * meanB + c1) * (2.0 * (products - meanA * meanB) + c2) /
           ((meanA * meanA + meanB * meanB + c1) * (variances + c2));
}

/// For each vertex, the mean of its triangles' normals.
std::vector<glm::vec3> normalsOf(const CoarseMesh& mesh)
{
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0f));
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner)
        normals[mesh.indices[corner]] += areaNormal(mesh.positions, &mesh.indices[corner - corner % 3]);
    for (glm::vec3& normal : normals)
        normal = unit(normal, glm::vec3(0.0f));
    return normals;
}

/// The nearest of some cells, which are in the order of their rows; at least one.
SurfaceViews::Cell nearest(const SurfaceViews::Cell& cell, const std::vector<SurfaceViews::Cell>& cells)
{
    const auto isAbove = [](const SurfaceViews::Cell& other, int row) { return other.y < row; };
    const auto start = std::lower_bound(cells.begin(), cells.end(), cell.y, isAbove);
    SurfaceViews::Cell found = cells.front();
    int min = std::numeric_limits<int>::max();
    const auto isBeyond = [&](const SurfaceViews::Cell& other)
    {
        const SurfaceViews::Cell way = other - cell;
        if (way.y * way.y >= min) return true;
        const int squaredDistance = way.x * way.x + way.y * way.y;
        if (squaredDistance < min) found = other;
        min = std::min(min, squaredDistance);
        return false;
    };
    static_cast<void>(std::find_if(start, cells.end(), isBeyond));
    static_cast<void>(std::find_if(std::make_reverse_iterator(start), cells.rend(), isBeyond));
    return found;
}

} // namespace

MergedViews::MergedViews(const MergedParts& parts) : _parts(parts), _views(parts.surface().poses)
{
    osg::Vec2 sum;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        std::vector<Look>& looks = _looks.emplace_back();
        std::vector<float>& shades = _shades.emplace_back();
        const std::vector<glm::vec3> normals = parts.normalsIn(_views.poseOf(view));
        const std::vector<Seen> cells =
            _views.seen(view, {parts.surface().poses, parts.indices(), parts.surface().isTwoSided});
        _outlines.push_back(SurfaceViews::outlineOf(cells));
        for (const Seen& seen : cells)
        {
            Look& look = looks.emplace_back();
            shades.push_back(0.0f);
            if (seen.triangle == Seen::none) continue;
            const SurfaceColor::Look surface = parts.lookAt(&parts.indices()[3 * seen.triangle], seen.barycentric);
            look = {true, lightAt(seen, view, normals), surface.color};
            shades.back() = shadeOf(parts.stored(look.color) * look.light);
            sum += surface.metallicRoughness;
            ++_covered;
        }
    }
    if (_covered > 0) _metallicRoughness = sum / static_cast<float>(_covered);
}

/// Of the parts. normals: in the view's pose.
float MergedViews::lightAt(const Seen& seen, std::size_t view, const std::vector<glm::vec3>& normals) const
{
    const std::uint32_t* triangle = &_parts.indices()[3 * seen.triangle];
    glm::vec3 normal(0.0f);
    for (int corner = 0; corner < 3; ++corner)
        normal += seen.barycentric[corner] * normals[triangle[corner]];
    const std::vector<glm::vec3>& positions = _parts.surface().poses[_views.poseOf(view)];
    normal = unit(normal, unit(areaNormal(positions, triangle), glm::vec3(0.0f)));
    return brightness(seen.isFront ? normal : -normal, _views.towards(view));
}

std::vector<std::uint32_t> MergedViews::oneSided(const std::vector<std::uint32_t>& indices) const
{
    if (!_parts.surface().isTwoSided) return indices;
    std::vector<std::size_t> fronts(indices.size() / 3), backs(indices.size() / 3);
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        for (const Seen& seen : _views.seen(view, {_parts.surface().poses, indices, true}))
            if (seen.triangle != Seen::none) ++(seen.isFront ? fronts : backs)[seen.triangle];
    std::vector<std::uint32_t> sided;
    for (std::size_t triangle = 0; triangle < fronts.size(); ++triangle)
    {
        const auto few = static_cast<std::size_t>(fewSeen * static_cast<double>(fronts[triangle] + backs[triangle]));
        const auto first = indices.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
        if (fronts[triangle] > few || backs[triangle] <= few) sided.insert(sided.end(), first, first + 3);
        if (backs[triangle] > few) sided.insert(sided.end(), {first[0], first[2], first[1]});
    }
    return sided;
}

/// Adds the ways between the outlines of the mesh and those of the parts in a view. turns: by vertex, to the first
/// pose.
void MergedViews::addMoves(const CoarseMesh& mesh, const Poses& poses, std::size_t view,
                           const std::vector<glm::mat3>& turns, Moves& moves) const
{
    const std::vector<Seen> cells = _views.seen(view, {poses, mesh.indices, false});
    const std::vector<SurfaceViews::Cell> outline = SurfaceViews::outlineOf(cells), &ofParts = _outlines[view];
    if (outline.empty() || ofParts.empty()) return;
    const auto add = [&](const SurfaceViews::Cell& from, const SurfaceViews::Cell& to)
    {
        const Seen& seen = cells[SurfaceViews::indexOf(from)];
        const glm::vec3 way = _views.wayBetween(view, from, to);
        for (int corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t vertex = mesh.indices[3 * seen.triangle + static_cast<std::uint32_t>(corner)];
            moves.sums[vertex] += seen.barycentric[corner] * (turns[vertex] * way);
            moves.weights[vertex] += seen.barycentric[corner];
        }
    };
    for (const SurfaceViews::Cell& cell : outline)
        add(cell, nearest(cell, ofParts));
    for (const SurfaceViews::Cell& cell : ofParts)
        add(nearest(cell, outline), cell);
}

void MergedViews::fitOutlines(CoarseMesh& mesh, double max) const
{
    const std::vector<glm::vec3> unmoved = mesh.positions;
    std::vector<std::vector<glm::mat3>> turns(SurfaceViews::viewCount); // by view, then vertex
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        for (const std::uint32_t source : mesh.sources)
            turns[view].push_back(_parts.toFirstPose(source, _views.poseOf(view)));
    for (int step = 0; step < outlineSteps; ++step)
    {
        const Poses poses = _parts.posesOf(mesh, SurfaceViews::poseCount);
        Moves moves{std::vector<glm::vec3>(unmoved.size(), glm::vec3(0.0f)), std::vector<float>(unmoved.size())};
        for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
            addMoves(mesh, poses, view, turns[view], moves);
        for (std::size_t vertex = 0; vertex < unmoved.size(); ++vertex)
        {
            if (!(moves.weights[vertex] > 0.0f)) continue;
            const glm::vec3 way = mesh.positions[vertex] + moves.sums[vertex] / moves.weights[vertex] - unmoved[vertex];
            const float length = glm::length(way), longest = static_cast<float>(max);
            mesh.positions[vertex] = unmoved[vertex] + way * (length > longest ? longest / length : 1.0f);
        }
    }
}

void MergedViews::fitCoverage(CoarseMesh& mesh, double max) const
{
    const std::vector<glm::vec3> normals = normalsOf(mesh), unmoved = mesh.positions;
    const auto move = [&](double length)
    {
        for (std::size_t vertex = 0; vertex < unmoved.size(); ++vertex)
            mesh.positions[vertex] = unmoved[vertex] + static_cast<float>(length) * normals[vertex];
    };
    double best = 0.0;
    std::size_t min = std::numeric_limits<std::size_t>::max();
    for (const double share : {0.0, 0.5, 1.0, -0.5, -1.0})
    {
        if (share * best < 0.0 || std::abs(share - best) > 0.5) continue; // the best is beside a better one
        move(share * max);
        const Poses poses = _parts.posesOf(mesh, SurfaceViews::poseCount);
        const std::size_t covered = _views.coveredCells({poses, mesh.indices, false});
        const std::size_t missing = std::max(covered, _covered) - std::min(covered, _covered); // or too many
        if (missing >= min) continue;
        min = missing;
        best = share;
    }
    move(best * max);
}

/// Of the mesh. positions: in the view's pose.
float MergedViews::lightOf(const std::vector<glm::vec3>& positions, const std::uint32_t* triangle,
                           std::size_t view) const
{
    const glm::vec3 towards = _views.towards(view);
    return brightness(unit(areaNormal(positions, triangle), towards), towards);
}

MergedViews::Shades MergedViews::fitColors(CoarseMesh& mesh, const Poses& poses) const
{
    struct Target
    {
        const std::uint32_t* triangle;
        glm::vec3 shares;
        float light;     ///< of the mesh
        osg::Vec4 shown; ///< by the parts
    };
    std::vector<Target> targets;
    SeenCells seen;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        const std::vector<glm::vec3>& positions = poses[_views.poseOf(view)];
        const std::vector<Seen>& cells = seen.emplace_back(_views.seen(view, {poses, mesh.indices, false}));
        for (std::size_t cell = 0; cell < cells.size(); ++cell)
        {
            const Look& look = _looks[view][cell];
            if (cells[cell].triangle == Seen::none || !look.isVisible) continue;
            const std::uint32_t* triangle = &mesh.indices[3 * cells[cell].triangle];
            targets.push_back(
                {triangle, cells[cell].barycentric, lightOf(positions, triangle, view), look.color * look.light});
        }
    }
    mesh.colors.clear();
    for (const std::uint32_t source : mesh.sources)
        mesh.colors.push_back(_parts.colorOf(source));
    for (int step = 0; step < fittingSteps; ++step)
    {
        std::vector<osg::Vec4> sums(mesh.colors.size());
        std::vector<float> weights(mesh.colors.size());
        for (const Target& target : targets)
        {
            osg::Vec4 missing = target.shown;
            for (int corner = 0; corner < 3; ++corner)
                missing -= mesh.colors[target.triangle[corner]] * (target.light * target.shares[corner]);
            for (int corner = 0; corner < 3; ++corner)
            {
                sums[target.triangle[corner]] += missing * target.shares[corner];
                weights[target.triangle[corner]] += target.light * target.shares[corner];
            }
        }
        for (std::size_t vertex = 0; vertex < mesh.colors.size(); ++vertex)
            if (weights[vertex] > 0.0f) mesh.colors[vertex] += sums[vertex] / weights[vertex];
    }
    for (osg::Vec4& color : mesh.colors)
    {
        for (int component = 0; component < 3; ++component)
            color[component] = std::clamp(color[component], 0.0f, 1.0f);
        color.a() = 1.0f;
    }
    return shadesOf(mesh, poses, seen);
}

/// seen: of the mesh.
MergedViews::Shades MergedViews::shadesOf(const CoarseMesh& mesh, const Poses& poses, const SeenCells& seen) const
{
    Shades shades;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        std::vector<float>& ofView = shades.emplace_back();
        for (const Seen& cell : seen[view])
        {
            ofView.push_back(0.0f);
            if (cell.triangle == Seen::none) continue;
            const std::uint32_t* triangle = &mesh.indices[3 * cell.triangle];
            osg::Vec4 color;
            for (int corner = 0; corner < 3; ++corner)
                color += mesh.colors[triangle[corner]] * cell.barycentric[corner];
            const float light = lightOf(poses[_views.poseOf(view)], triangle, view);
            ofView.back() = shadeOf(_parts.stored(color) * light);
        }
    }
    return shades;
}

double MergedViews::similarity(const Shades& shades, double pixel) const
{
    double sum = 0.0;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        const double cells = pixel / _views.cellSize(view);
        sum += structuralSimilarity(pixelsOf(_shades[view], cells), pixelsOf(shades[view], cells));
    }
    return sum / SurfaceViews::viewCount;
}

} // namespace osgGpuAnimation
