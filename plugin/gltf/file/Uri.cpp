// SPDX-License-Identifier: MIT
#include "gltf/file/Uri.h"

#include "gltf/file/Report.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

/// data:KIND,PAYLOAD
struct DataUriParts
{
    std::string_view kind;
    std::string_view payload; ///< base64 without padding, or percent-encoded
    bool isBase64 = false;

    /// The decoded size of a payload without faults.
    std::size_t bytes() const
    {
        if (isBase64) return payload.size() / 4 * 3 + payload.size() % 4 * 3 / 4;
        const auto encoded = static_cast<std::size_t>(std::count(payload.begin(), payload.end(), '%'));
        return payload.size() - 2 * std::min(encoded, payload.size() / 3);
    }
};

/// Out: a string or bytes, of which no more than `max` are kept.
template <typename Out>
Result<Out> decodePercent(std::string_view text, std::size_t max)
{
    Out out;
    out.reserve(max);
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (text[i] != '%')
        {
            if (out.size() < max) out.push_back(static_cast<typename Out::value_type>(text[i]));
            continue;
        }
        std::uint8_t byte = 0;
        const std::string_view digits = text.substr(i + 1, 2);
        const char* const end = digits.data() + digits.size();
        if (digits.size() < 2 || std::from_chars(digits.data(), end, byte, 16).ptr != end)
            return unexpected("two hexadecimal digits after %", quoted(text.substr(i, 3)));
        if (out.size() < max) out.push_back(static_cast<typename Out::value_type>(byte));
        i += 2;
    }
    return out;
}

/// The value of each base64 digit, 255 for other characters.
constexpr std::array<std::uint8_t, 256> base64Values()
{
    std::array<std::uint8_t, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = 255;
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<std::size_t>(digits[i])] = static_cast<std::uint8_t>(i);
    return values;
}

std::string_view withoutPadding(std::string_view base64)
{
    for (int padding = 0; padding < 2 && !base64.empty() && base64.back() == '='; ++padding)
        base64.remove_suffix(1);
    return base64;
}

Result<Bytes> decodeBase64(std::string_view text, std::size_t max)
{
    static constexpr std::array<std::uint8_t, 256> values = base64Values();
    Bytes out;
    out.reserve(max);
    std::uint32_t bits = 0;
    int count = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const std::uint8_t value = values[static_cast<unsigned char>(text[i])];
        if (value == 255)
            return unexpected("base64",
                              quoted(text.substr(i, 1)) + " at character " + std::to_string(i) + " of the data");
        bits = bits << 6 | value;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        if (out.size() < max) out.push_back(static_cast<unsigned char>(bits >> count));
    }
    if (count == 6) return unexpected("base64", "data that ends in the middle of a byte");
    return out;
}

bool equalsIgnoringCase(std::string_view text, std::string_view lower)
{
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

Result<DataUriParts> splitDataUri(std::string_view uri)
{
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return unexpected("a comma and data after data:", quoted(uri));
    DataUriParts parts{uri.substr(5, comma - 5), uri.substr(comma + 1), false};
    const std::string_view marker = ";base64";
    parts.isBase64 = parts.kind.size() >= marker.size() &&
                     equalsIgnoringCase(parts.kind.substr(parts.kind.size() - marker.size()), marker);
    if (parts.isBase64) parts.payload = withoutPadding(parts.payload);
    return parts;
}

/// True if the text begins with a scheme or drive letter: http: or C: (RFC 3986, section 3.1).
bool hasScheme(std::string_view uri)
{
    if (uri.empty() || !std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
    const std::size_t end =
        std::find_if(uri.begin(), uri.end(),
                     [](char c)
                     { return !std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.'; }) -
        uri.begin();
    return end < uri.size() && uri[end] == ':';
}

namespace fs = std::filesystem;

Error outside(const std::string& path)
{
    return Error{"expected a file in the model's folder or below it, found " + quoted(path) +
                 " (the option allowOutsideFiles lets it be read)"};
}

Error noFileName(const std::string& path, const std::system_error& fault)
{
    return Error{"expected a file, found " + quoted(path) + ": " + fault.code().message()};
}

fs::path folderOf(const fs::path& file)
{
    return file.has_parent_path() ? file.parent_path() : ".";
}

/// Also for a drive's own folder, C:file on Windows.
bool leavesFolder(const fs::path& relative)
{
    const fs::path normal = relative.lexically_normal();
    return relative.has_root_path() || (normal.begin() != normal.end() && *normal.begin() == "..");
}

} // namespace

bool isBelow(const fs::path& file, const fs::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

bool isDataUri(std::string_view uri)
{
    return equalsIgnoringCase(uri.substr(0, 5), "data:");
}

Result<std::size_t> bytesOfDataUri(std::string_view uri)
{
    const Result<DataUriParts> parts = splitDataUri(uri);
    if (!parts) return parts.error();
    return parts.value().bytes();
}

Result<DataUri> decodeDataUri(std::string_view uri, std::size_t max)
{
    const Result<DataUriParts> parts = splitDataUri(uri);
    if (!parts) return parts.error();
    const auto& [kind, payload, isBase64] = parts.value();
    const std::size_t kept = std::min(max, parts.value().bytes());
    Result<Bytes> bytes = isBase64 ? decodeBase64(payload, kept) : decodePercent<Bytes>(payload, kept);
    if (!bytes) return bytes.error();
    return DataUri{std::string(kind.substr(0, kind.find(';'))), std::move(bytes).value()};
}

Result<std::string> decodePath(std::string_view uri)
{
    if (uri.empty()) return unexpected("a relative path or a data URI", "an empty text");
    if (hasScheme(uri)) return unexpected("a relative path or a data URI", quoted(uri));
    Result<std::string> path = decodePercent<std::string>(uri, uri.size());
    if (!path) return path;
    if (path.value().find('\0') != std::string::npos) return unexpected("a path without NUL", quoted(uri));
    if (path.value().find('\\') != std::string::npos)
        return unexpected("a path with slashes, not backslashes", quoted(uri));
    return path;
}

Result<RegularFile> ModelFolder::open(std::string_view uri) const
{
    const Result<std::string> path = decodePath(uri);
    if (!path) return path.error();
    if (_modelFile.empty())
        return Error{"expected data in the model itself, which came without a file name, found " + quoted(uri)};
    return openPath(path.value());
}

// On Windows not every text can be a file name.
Result<std::string> ModelFolder::find(const std::string& path) const
try
{
    const fs::path folder = folderOf(_modelFile);
    std::error_code error;
    fs::path file = fs::canonical(folder / path, error);
    if (error) file = fs::canonical(path, error);
    if (error) return Error{"the file does not exist"};
    const fs::path home = fs::canonical(folder, error);
    if (!_allowOutsideFiles && (error || _modelFile.empty() || !isBelow(file, home))) return outside(path);
    if (file == fs::canonical(_modelFile, error) && !error) return Error{"it is the model file itself"};
    return file.string();
}
catch (const std::system_error& fault)
{
    return noFileName(path, fault);
}

Result<RegularFile> ModelFolder::openPath(const std::string& path) const
try
{
    // Check the text first: files outside the folder are never looked up.
    if (!_allowOutsideFiles && leavesFolder(path)) return outside(path);
    const fs::path folder = folderOf(_modelFile);
    std::error_code error;
    const fs::path found = fs::canonical(folder / path, error);
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
        return Error{"expected a file, found that " + quoted(path) + " does not exist"};
    if (error) return Error{"expected a file, found " + quoted(path) + ": " + error.message()};
    const fs::path home = _allowOutsideFiles ? fs::path() : fs::canonical(folder, error);
    if (error) return Error{"the model's folder cannot be found: " + error.message()};
    if (!_allowOutsideFiles && !isBelow(found, home)) return outside(path);
    Result<RegularFile> file = RegularFile::open(found.string());
    if (!file) return Error{quoted(path) + ": " + file.error().message};
    if (file.value().isSameAs(_modelFile)) return Error{"expected a file of its own, found the model file itself"};
    return file;
}
catch (const std::system_error& fault)
{
    return noFileName(path, fault);
}

} // namespace osgGpuAnimation::gltf
