// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "Scenes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr int across = 10; ///< instances of a row, and rows
constexpr int samples = 8; ///< of a pixel, in each direction
constexpr int window = 8;  ///< of the structural similarity, in pixels

/// Brightness in [0, 1] of square pixels, and the share of the samples that are drawn.
struct Picture
{
    int width;
    std::vector<double> brightness;
    double drawn;
};

/// The last frame; each pixel is the mean of as many samples in each direction.
Picture pictureOf(StagedViewer& viewer, int width, int samplesOfPixel)
{
    const std::vector<unsigned char> pixels = viewer.pixels();
    const std::size_t side = static_cast<std::size_t>(width) * static_cast<std::size_t>(samplesOfPixel);
    Picture picture{
        width, std::vector<double>(pixels.size() / 4 / static_cast<std::size_t>(samplesOfPixel * samplesOfPixel)), 0.0};
    for (std::size_t sample = 0; sample < pixels.size() / 4; ++sample)
    {
        const unsigned char* rgb = &pixels[4 * sample];
        const std::size_t x = sample % side / static_cast<std::size_t>(samplesOfPixel),
                          y = sample / side / static_cast<std::size_t>(samplesOfPixel);
        const double sum = rgb[0] + rgb[1] + rgb[2];
        picture.brightness[y * static_cast<std::size_t>(width) + x] +=
            sum / (3.0 * 255.0 * samplesOfPixel * samplesOfPixel);
        if (sum > 0.0) picture.drawn += 1.0 / static_cast<double>(pixels.size() / 4);
    }
    return picture;
}

/// The mean over all windows; 1: equal pictures.
double structuralSimilarity(const Picture& a, const Picture& b)
{
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03, count = window * window;
    const int height = static_cast<int>(a.brightness.size()) / a.width;
    double sum = 0.0;
    int windows = 0;
    for (int top = 0; top + window <= height; ++top)
        for (int left = 0; left + window <= a.width; ++left, ++windows)
        {
            double meanA = 0.0, meanB = 0.0, squaresA = 0.0, squaresB = 0.0, products = 0.0;
            for (int y = top; y < top + window; ++y)
                for (int x = left; x < left + window; ++x)
                {
                    const auto pixel = static_cast<std::size_t>(y * a.width + x);
                    const double ofA = a.brightness[pixel], ofB = b.brightness[pixel];
                    meanA += ofA / count;
                    meanB += ofB / count;
                    squaresA += ofA * ofA / count;
                    squaresB += ofB * ofB / count;
                    products += ofA * ofB / count;
                }
            const double covariance = products - meanA * meanB;
            const double variances = squaresA - meanA * meanA + squaresB - meanB * meanB;
            sum += (2.0 * meanA * meanB + c1) * (2.0 * covariance + c2) /
                   ((meanA * meanA + meanB * meanB + c1) * (variances + c2));
        }
    return sum / windows;
}

/// Instances on a wall, each with some clip, time and direction.
osg::ref_ptr<AnimatedCrowd> makeWall(const Subject& subject, double spacing)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*subject.model.character);
    std::mt19937 random(1);
    for (int place = 0; place < across * across; ++place)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        static_cast<void>(controller.play(random() % subject.set().clips().size()));
        controller.seek(1e-3 * static_cast<double>(random() % 1000) * controller.duration());
        const osg::Matrixd turned = osg::Matrixd::rotate(1e-3 * static_cast<double>(random() % 6283), 0.0, 0.0, 1.0);
        const double x = spacing * (place % across - 0.5 * across), z = spacing * (place / across - 0.5 * across);
        static_cast<void>(crowd->add(turned * osg::Matrixd::translate(x, 0.0, z), controller));
    }
    return crowd;
}

/// Of instances of that height in pixels: with the pixel error, and exact ones.
void comparePictures(const Subject& subject, int pixels, Report& report)
{
    const osg::BoundingBox box = subject.model.character->getClipBounds(-1);
    const double tall = box.zMax() - box.zMin(), spacing = 2.0 * tall;
    const int width = 2 * pixels * across;
    const osg::ref_ptr<AnimatedCrowd> wall = makeWall(subject, spacing);
    StagedViewer viewer(wall, wall->getBound(), samples * width);
    constexpr double fieldOfView = 10.0; // degrees
    const osg::Vec3d centre(-0.5 * spacing, 0.5 * (box.yMin() + box.yMax()),
                            0.5 * (box.zMin() + box.zMax()) - 0.5 * spacing);
    const double distance = 0.5 * across * spacing / std::tan(osg::DegreesToRadians(0.5 * fieldOfView));
    viewer.lookFrom(centre - osg::Vec3d(0.0, distance, 0.0), centre, fieldOfView);
    std::vector<Picture> pictures;
    for (const float error : {0.0f, samples * fieldPixelError})
    {
        taken(wall->getMeshes().setPixelError(error));
        for (int frame = 0; frame < 2; ++frame)
            viewer.frameAt(0.0);
        pictures.push_back(pictureOf(viewer, width, samples));
    }
    viewer.requireNoErrors();
    const auto row = [&](const std::string& what, double value)
    {
        return Row(subject.name, across * across, "pictures, " + what + ", " + std::to_string(pixels) + " pixels tall",
                   "%", figureOf(100.0 * value));
    };
    Row coverage = row("coverage", pictures[1].drawn / pictures[0].drawn);
    coverage.bar = "98 to 102 %";
    coverage.isMet = std::abs(coverage.ours.median - 100.0) <= 2.0;
    report.add(coverage);
    report.add(row("structural similarity", structuralSimilarity(pictures[0], pictures[1])).atLeast(98.0));
}

/// The mean brightness of the drawn pixels of each row; below 0 where few are drawn.
std::vector<double> brightnessOfRows(const Picture& picture)
{
    constexpr int minDrawn = 200; // pixels
    std::vector<double> rows;
    for (auto row = picture.brightness.begin(); row != picture.brightness.end(); row += picture.width)
    {
        const auto drawn = picture.width - std::count(row, row + picture.width, 0.0);
        rows.push_back(drawn < minDrawn ? -1.0
                                        : std::accumulate(row, row + picture.width, 0.0) / static_cast<double>(drawn));
    }
    return rows;
}

/// The largest change of brightness from some rows of the field to the next ones that the pixel error brings: a line
/// where levels change.
void compareRows(const Subject& subject, Report& report)
{
    constexpr std::size_t band = 8; // rows on each side
    constexpr int width = 1280, height = 720;
    const Field field(subject);
    const osg::BoundingSphere bound = field.node().getBound();
    StagedViewer viewer(&field.node(), bound, width, height);
    lookAcross(viewer, bound);
    std::vector<std::vector<double>> rows;
    for (const float error : {0.0f, fieldPixelError})
    {
        taken(field.node().getMeshes().setPixelError(error));
        viewer.frameAt(0.0);
        rows.push_back(brightnessOfRows(pictureOf(viewer, width, 1)));
    }
    viewer.requireNoErrors();
    std::vector<double> ratios;
    for (std::size_t row = 0; row < rows[0].size(); ++row)
        if (rows[0][row] > 0.0 && rows[1][row] > 0.0) ratios.push_back(rows[1][row] / rows[0][row]);
    if (ratios.size() < 2 * band)
        throw std::runtime_error("the field's picture has " + std::to_string(ratios.size()) + " rows");
    double largest = 0.0;
    for (auto at = ratios.begin() + band; at + band <= ratios.end(); ++at)
        largest = std::max(largest,
                           std::abs(std::accumulate(at, at + band, 0.0) / std::accumulate(at - band, at, 0.0) - 1.0));
    report.add(
        Row(subject.name, places, "pictures, the field's largest step of brightness", "%", figureOf(100.0 * largest))
            .atMost(2.0));
}

} // namespace

void measurePictures(const Subject& subject, Run& run)
{
    for (const int pixels : {4, 8, 16})
        comparePictures(subject, pixels, run.report);
    compareRows(subject, run.report);
}

} // namespace osgGpuAnimation::benchmark
