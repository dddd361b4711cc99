// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/environment/RadianceCube.h>

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/Math>

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>

namespace osgGpuAnimation
{

namespace
{

constexpr float maxHalf = 65504.0f; ///< of half floats
const char* const faceNames[] = {"POSITIVE_X", "NEGATIVE_X", "POSITIVE_Y", "NEGATIVE_Y", "POSITIVE_Z", "NEGATIVE_Z"};

std::string sizeText(int width, int height)
{
    return std::to_string(width) + "x" + std::to_string(height);
}

float linearOf(float encoded)
{
    return linearColor(osg::Vec4(encoded, 0.0f, 0.0f, 1.0f)).r();
}

/// The components of a pixel in its format.
struct PixelFormat
{
    int count = 0; ///< 0: not a format of the list
    int red = 0, green = 0, blue = 0;
};

PixelFormat formatOf(GLenum format)
{
    static const std::map<GLenum, PixelFormat> formats = {
        {GL_LUMINANCE, {1, 0, 0, 0}}, {GL_RED, {1, 0, 0, 0}}, {GL_LUMINANCE_ALPHA, {2, 0, 0, 0}},
        {GL_RG, {2, 0, 1, 1}},        {GL_RGB, {3, 0, 1, 2}}, {GL_RGBA, {4, 0, 1, 2}},
        {GL_BGR, {3, 2, 1, 0}},       {GL_BGRA, {4, 2, 1, 0}}};
    const auto known = formats.find(format);
    return known == formats.end() ? PixelFormat() : known->second;
}

bool isReadable(GLenum type)
{
    return type == GL_UNSIGNED_BYTE || type == GL_UNSIGNED_SHORT || type == GL_HALF_FLOAT || type == GL_FLOAT;
}

/// Linear components, cleaned. bytes: of one component; they need not be aligned.
class ComponentReader
{
public:
    explicit ComponentReader(GLenum type) : _type(type)
    {
        for (std::size_t byte = 0; byte < _bytes.size(); ++byte)
            _bytes[byte] = linearOf(static_cast<float>(byte) / 255.0f);
    }

    std::size_t size() const { return _type == GL_UNSIGNED_BYTE ? 1 : _type == GL_FLOAT ? 4 : 2; }

    float operator()(const unsigned char* bytes) const
    {
        if (_type == GL_UNSIGNED_BYTE) return _bytes[*bytes];
        if (_type == GL_UNSIGNED_SHORT) return linearOf(static_cast<float>(read<std::uint16_t>(bytes)) / 65535.0f);
        const float value = _type == GL_FLOAT ? read<float>(bytes) : glm::unpackHalf1x16(read<std::uint16_t>(bytes));
        return std::isfinite(value) ? std::clamp(value, 0.0f, maxHalf) : 0.0f;
    }

private:
    template <typename Value>
    static Value read(const unsigned char* bytes)
    {
        Value value;
        std::memcpy(&value, bytes, sizeof value);
        return value;
    }

    GLenum _type;
    std::array<float, 256> _bytes;
};

/// Linear radiance by rows.
struct RadiancePicture
{
    /// Between the pixels' centres; wraps around in x if the picture is a panorama. x, y: in pixels.
    osg::Vec3f sample(float x, float y, bool wraps) const
    {
        const float left = std::floor(x - 0.5f), low = std::floor(y - 0.5f);
        const float right = x - 0.5f - left, high = y - 0.5f - low;
        const auto row = [&](float from)
        {
            const int at = std::clamp(static_cast<int>(from), 0, height - 1) * width;
            const auto column = [&](float to)
            {
                const int place = static_cast<int>(to);
                return wraps ? (place + width) % width : std::clamp(place, 0, width - 1);
            };
            return pixels[static_cast<std::size_t>(at + column(left))] * (1.0f - right) +
                   pixels[static_cast<std::size_t>(at + column(left + 1.0f))] * right;
        };
        return row(low) * (1.0f - high) + row(low + 1.0f) * high;
    }

    int width = 0, height = 0;
    std::vector<osg::Vec3f> pixels;
};

/// Each pixel is the mean of step x step pixels of the image, fewer at the ends.
RadiancePicture readPicture(const osg::Image& image, int step)
{
    const PixelFormat format = formatOf(image.getPixelFormat());
    const ComponentReader component(image.getDataType());
    const std::size_t pixelBytes = component.size() * static_cast<std::size_t>(format.count);
    RadiancePicture picture;
    picture.width = (image.s() + step - 1) / step;
    picture.height = (image.t() + step - 1) / step;
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    const int offsets[] = {format.red, format.green, format.blue};
    for (int y = 0; y < image.t(); ++y)
    {
        const unsigned char* row = image.data(0, static_cast<unsigned int>(y));
        const std::size_t first = static_cast<std::size_t>(y / step) * static_cast<std::size_t>(picture.width);
        for (int x = 0; x < image.s(); ++x, row += pixelBytes)
            for (int channel = 0; channel < 3; ++channel)
                picture.pixels[first + static_cast<std::size_t>(x / step)][channel] +=
                    component(row + component.size() * static_cast<std::size_t>(offsets[channel]));
    }
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
        {
            const int count = std::min(step, image.s() - x * step) * std::min(step, image.t() - y * step);
            picture.pixels[static_cast<std::size_t>(y * picture.width + x)] /= static_cast<float>(count);
        }
    return picture;
}

Result<void> checkImage(const osg::Image* image)
{
    if (!image || !image->data() || image->s() < 1 || image->t() < 1)
        return Error{"expected a picture, found no pixels"};
    if (image->r() != 1) return Error{"expected a picture of one layer, found " + std::to_string(image->r())};
    if (formatOf(image->getPixelFormat()).count > 0 && isReadable(image->getDataType())) return {};
    std::ostringstream message;
    message << "expected RGB or luminance of 8 or 16 bits, half floats or floats, found the pixel format 0x" << std::hex
            << image->getPixelFormat() << " with the data type 0x" << image->getDataType();
    return Error{message.str()};
}

/// The mean of 2x2 samples in each pixel of the face. radiance: osg::Vec3f(float s, float t), s and t in [-1, 1].
template <typename Radiance>
std::vector<osg::Vec3f> makeFace(Radiance radiance)
{
    constexpr int side = RadianceCube::side;
    std::vector<osg::Vec3f> pixels;
    pixels.reserve(static_cast<std::size_t>(side) * side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
        {
            osg::Vec3f sum;
            for (const float dy : {0.25f, 0.75f})
                for (const float dx : {0.25f, 0.75f})
                    sum += radiance((static_cast<float>(x) + dx) * 2.0f / side - 1.0f,
                                    (static_cast<float>(y) + dy) * 2.0f / side - 1.0f);
            pixels.push_back(sum * 0.25f);
        }
    return pixels;
}

/// The means of blocks of block x block pixels.
std::vector<osg::Vec3f> reduced(const std::vector<osg::Vec3f>& face, int block)
{
    const int side = RadianceCube::side / block;
    std::vector<osg::Vec3f> means(static_cast<std::size_t>(side * side));
    const float weight = 1.0f / static_cast<float>(block * block);
    for (int y = 0; y < RadianceCube::side; ++y)
        for (int x = 0; x < RadianceCube::side; ++x)
            means[static_cast<std::size_t>(y / block * side + x / block)] +=
                face[static_cast<std::size_t>(y * RadianceCube::side + x)] * weight;
    return means;
}

/// A part of the sphere.
struct Patch
{
    osg::Vec3f towards; ///< unit length
    osg::Vec3f radiance;
    double weight; ///< in proportion to the solid angle
};

/// Patches of block x block pixels of each face.
std::vector<Patch> patchesOf(const std::array<std::vector<osg::Vec3f>, 6>& faces, int block)
{
    const auto coarse = static_cast<std::size_t>(RadianceCube::side / block);
    const auto place = [coarse](std::size_t at)
    { return (static_cast<float>(at) + 0.5f) * 2.0f / static_cast<float>(coarse) - 1.0f; };
    std::vector<Patch> patches;
    for (int face = 0; face < 6; ++face)
    {
        const std::vector<osg::Vec3f> pixels = reduced(faces[static_cast<std::size_t>(face)], block);
        for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel)
        {
            const float s = place(pixel % coarse), t = place(pixel / coarse);
            patches.push_back({RadianceCube::direction(face, s, t), pixels[pixel],
                               std::pow(1.0 + static_cast<double>(s * s + t * t), -1.5)});
        }
    }
    return patches;
}

/// The light of one patch on level ground, in proportion to its irradiance.
double groundLight(const Patch& patch)
{
    const osg::Vec3f luminance(0.2126f, 0.7152f, 0.0722f);
    return std::max(0.0, static_cast<double>(patch.towards.y())) * patch.weight *
           static_cast<double>(patch.radiance * luminance);
}

/// The patch around which most light on the ground comes from a lobe as narrow as that of the studio's key light.
osg::Vec3f brightest(const std::vector<Patch>& patches)
{
    constexpr float sharpness = 40.0f, lowest = 0.1736f; // the sine of 10 degrees
    osg::Vec3f towards(0, 1, 0);
    double max = 0.0;
    for (const Patch& candidate : patches)
    {
        if (candidate.towards.y() < lowest) continue;
        double sum = 0.0;
        for (const Patch& patch : patches)
            if (const float cosine = candidate.towards * patch.towards; cosine > 0.8f)
                sum += groundLight(patch) * static_cast<double>(std::exp(sharpness * (cosine - 1.0f)));
        if (sum > 1.0001 * max)
        {
            max = sum;
            towards = candidate.towards;
        }
    }
    return towards;
}

} // namespace

osg::Vec3f RadianceCube::direction(int face, float s, float t)
{
    const osg::Vec3f directions[] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    osg::Vec3f direction = directions[face];
    direction.normalize();
    return direction;
}

Result<osg::ref_ptr<const RadianceCube>> RadianceCube::fromPanorama(const osg::Image& panorama)
{
    const Result<void> checked = checkImage(&panorama);
    if (!checked) return Error{"a panorama: " + checked.error().message};
    if (panorama.s() != 2 * panorama.t())
        return Error{"a panorama: expected twice as many pixels across as up, found " +
                     sizeText(panorama.s(), panorama.t())};
    const RadiancePicture picture = readPicture(panorama, std::max(1, panorama.s() / (4 * side)));
    osg::ref_ptr<RadianceCube> cube = new RadianceCube;
    for (int face = 0; face < 6; ++face)
        cube->_faces[static_cast<std::size_t>(face)] = makeFace(
            [&](float s, float t)
            {
                const osg::Vec3f towards = direction(face, s, t);
                const float u = std::atan2(towards.z(), towards.x()) / (2.0f * osg::PIf) + 0.5f;
                const float v = std::asin(std::clamp(towards.y(), -1.0f, 1.0f)) / osg::PIf + 0.5f;
                return picture.sample(u * static_cast<float>(picture.width), v * static_cast<float>(picture.height),
                                      true);
            });
    return osg::ref_ptr<const RadianceCube>(cube);
}

Result<osg::ref_ptr<const RadianceCube>> RadianceCube::fromFaces(const osg::TextureCubeMap& faces)
{
    osg::ref_ptr<RadianceCube> cube = new RadianceCube;
    const osg::Image* first = faces.getImage(0);
    for (unsigned int face = 0; face < 6; ++face)
    {
        const osg::Image* image = faces.getImage(face);
        const Result<void> checked = checkImage(image);
        const std::string subject = std::string("the face ") + faceNames[face] + ": ";
        if (!checked) return Error{subject + checked.error().message};
        if (image->s() != first->s() || image->t() != first->s())
            return Error{subject + "expected " + sizeText(first->s(), first->s()) + " pixels, found " +
                         sizeText(image->s(), image->t())};
        const RadiancePicture picture = readPicture(*image, std::max(1, image->s() / side));
        const float half = 0.5f * static_cast<float>(picture.width);
        cube->_faces[face] =
            makeFace([&](float s, float t) { return picture.sample((s + 1.0f) * half, (t + 1.0f) * half, false); });
    }
    return osg::ref_ptr<const RadianceCube>(cube);
}

std::array<osg::Vec3f, 9> RadianceCube::harmonics() const
{
    std::array<osg::Vec3d, 9> sums;
    double solidAngle = 0.0;
    for (const Patch& patch : patchesOf(_faces, 8))
    {
        const osg::Vec3d d = patch.towards;
        const double basis[] = {1.0,
                                d.y(),
                                d.z(),
                                d.x(),
                                d.x() * d.y(),
                                d.y() * d.z(),
                                3.0 * d.z() * d.z() - 1.0,
                                d.x() * d.z(),
                                d.x() * d.x() - d.y() * d.y()};
        for (std::size_t i = 0; i < sums.size(); ++i)
            sums[i] += osg::Vec3d(patch.radiance) * (basis[i] * patch.weight);
        solidAngle += patch.weight;
    }
    // The squared norms of the harmonics, and the factors 1, 2/3 and 1/4 of the cosine lobe, both times 4 pi.
    const double factors[] = {1.0, 2.0, 2.0, 2.0, 3.75, 3.75, 0.3125, 3.75, 0.9375};
    std::array<osg::Vec3f, 9> result;
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = sums[i] * (factors[i] / solidAngle);
    return result;
}

KeyLight RadianceCube::keyLight() const
{
    constexpr float cone = 0.906f, ring = 0.766f; // the cosines of 25 and 40 degrees
    const osg::Vec3f middle = brightest(patchesOf(_faces, 16));
    const std::vector<Patch> patches = patchesOf(_faces, 8);
    double around = 0.0, aroundWeight = 0.0, all = 0.0, excess = 0.0;
    for (const Patch& patch : patches)
    {
        const float cosine = patch.towards * middle;
        all += groundLight(patch);
        if (cosine > cone || cosine < ring || patch.towards.y() <= 0.0f) continue;
        around += groundLight(patch);
        aroundWeight += patch.weight * static_cast<double>(patch.towards.y());
    }
    const double evenLight = aroundWeight > 0.0 ? around / aroundWeight : 0.0;
    osg::Vec3d sum;
    for (const Patch& patch : patches)
    {
        if (patch.towards * middle <= cone || patch.towards.y() <= 0.0f) continue;
        const double level = evenLight * patch.weight * static_cast<double>(patch.towards.y());
        const double more = std::max(0.0, groundLight(patch) - level);
        excess += more;
        sum += osg::Vec3d(patch.towards) * more;
    }
    KeyLight light;
    if (excess <= 0.02 * all) return light; // an even sky
    sum.normalize();
    light.towards = sum;
    light.share = static_cast<float>(excess / all);
    return light;
}

} // namespace osgGpuAnimation
