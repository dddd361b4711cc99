// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/OutfitsFile.h>

#include <osgGpuAnimation/nodes/files/JsonText.h>

#include <cmath>
#include <filesystem>

namespace osgGpuAnimation
{

using namespace json;

namespace
{

osg::Vec4 toColor(const Json& json, const std::string& where)
{
    expect(json.is_string(), where, "a string", json);
    const std::string text = json.get<std::string>();
    if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
        throw JsonFault{where + ": \"" + text + "\" is no colour like \"#7a5c3a\""};
    const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
    const auto channel = [rgb](int shift) { return static_cast<float>(rgb >> shift & 255u) / 255.0f; };
    return {channel(16), channel(8), channel(0), 1.0f};
}

/// A file in the folder or below it.
std::string pathOf(const Json& json, const std::string& where, const std::string& folder)
{
    expect(json.is_string(), where, "a string", json);
    const std::filesystem::path path = json.get<std::string>();
    bool isBelow = !path.has_root_path() && !path.empty();
    for (const std::filesystem::path& part : path)
        isBelow = isBelow && part != "..";
    if (!isBelow) throw JsonFault{where + ": \"" + path.string() + "\" is not in the folder of the file"};
    return (std::filesystem::path(folder) / path).string();
}

/// Numbers of an array of three.
osg::Vec3d toVector(const Json& json, const std::string& where, const char* expected)
{
    bool isVector = json.is_array() && json.size() == 3;
    for (const Json& number : json)
        isVector = isVector && number.is_number();
    expect(isVector, where, expected, json);
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

osg::Vec3d toSize(const Json& json, const std::string& where)
{
    const osg::Vec3d size = json.is_number() ? osg::Vec3d(1, 1, 1) * json.get<double>()
                                             : toVector(json, where, "a number or an array of three numbers");
    for (int axis = 0; axis < 3; ++axis)
        if (!(size[axis] > 0.0 && std::isfinite(size[axis])))
            throw JsonFault{where + ": expected above 0, found " + std::to_string(size[axis])};
    return size;
}

osg::Matrixd toOffset(const Json& prop, const std::string& where)
{
    const auto offset = prop.find("offset");
    if (offset == prop.end()) return {};
    return osg::Matrixd::translate(toVector(*offset, where + ".offset", "an array of three numbers"));
}

/// The member, which is an object or an array as `isOf` says; an empty value if there is none.
const Json& memberOf(const Json& object, const char* name, const std::string& where,
                     bool (Json::*isOf)() const noexcept, const char* expected)
{
    static const Json none = Json::object();
    const auto found = object.find(name);
    if (found == object.end()) return none;
    expect(((*found).*isOf)(), where + "." + name, expected, *found);
    return *found;
}

/// Reads outfits that name files in a folder.
class OutfitReader
{
public:
    OutfitReader(const std::string& folder, const OutfitReaders& readers) : _folder(folder), _readers(readers) {}

    std::vector<OutfitShare> read(const Json& json)
    {
        checkObject(json, "the file", {"outfits"});
        requireMember(json, "outfits", "the file");
        std::vector<OutfitShare> outfits;
        double shares = 0.0;
        for (const Json& outfit : memberOf(json, "outfits", "the file", &Json::is_array, "an array"))
        {
            outfits.push_back(toOutfit(outfit, "outfits[" + std::to_string(outfits.size()) + "]"));
            shares += outfits.back().share;
        }
        if (!(shares > 0.0)) throw JsonFault{"outfits: there is none with a share above 0"};
        return outfits;
    }

private:
    OutfitShare toOutfit(const Json& json, const std::string& where)
    {
        checkObject(json, where,
                    {"name", "share", "size", "hide", "show", "variant", "colors", "pictures", "proportions", "props"});
        OutfitShare made{new Outfit};
        std::string name, variant;
        readText(json, "name", where, name);
        readText(json, "variant", where, variant);
        made.outfit->setName(name);
        made.outfit->setVariant(variant);
        readNumber(json, "share", where, made.share);
        if (json.contains("size")) made.size = toSize(json["size"], where + ".size");
        if (!(made.share >= 0.0 && std::isfinite(made.share)))
            throw JsonFault{where + ".share: expected at least 0, found " + std::to_string(made.share)};
        for (const bool isVisible : {false, true})
            if (const char* const member = isVisible ? "show" : "hide"; json.contains(member))
                for (const std::string& part : toTexts(json[member], where + "." + member))
                    made.outfit->setVisible(part, isVisible);
        for (const auto& color : memberOf(json, "colors", where, &Json::is_object, "an object").items())
            made.outfit->setColor(color.key(), toColor(color.value(), where + ".colors." + color.key()));
        for (const auto& picture : memberOf(json, "pictures", where, &Json::is_object, "an object").items())
            made.outfit->setPicture(picture.key(), toPicture(picture.value(), where + ".pictures." + picture.key()));
        for (const auto& joint : memberOf(json, "proportions", where, &Json::is_object, "an object").items())
            made.outfit->setJointScale(joint.key(), toSize(joint.value(), where + ".proportions." + joint.key()));
        const Json& props = memberOf(json, "props", where, &Json::is_array, "an array");
        for (std::size_t i = 0; i < props.size(); ++i)
            addProp(props[i], where + ".props[" + std::to_string(i) + "]", *made.outfit);
        return made;
    }

    osg::Image* toPicture(const Json& json, const std::string& where)
    {
        const std::string path = pathOf(json, where, _folder);
        osg::ref_ptr<osg::Image>& picture = _pictures[path];
        if (!picture && _readers.picture) picture = _readers.picture(path);
        if (!picture) throw JsonFault{where + ": " + path + " is no picture that can be read"};
        return picture;
    }

    void addProp(const Json& json, const std::string& where, Outfit& outfit)
    {
        checkObject(json, where, {"joint", "file", "offset"});
        requireMember(json, "joint", where);
        requireMember(json, "file", where);
        std::string joint;
        readText(json, "joint", where, joint);
        const std::string path = pathOf(json["file"], where + ".file", _folder);
        osg::ref_ptr<osg::Node>& node = _nodes[path];
        if (!node && _readers.model) node = _readers.model(path);
        if (!node) throw JsonFault{where + ".file: " + path + " is no model that can be read"};
        outfit.addProp(joint, node, toOffset(json, where));
    }

    const std::string _folder;
    const OutfitReaders& _readers;
    std::map<std::string, osg::ref_ptr<osg::Image>> _pictures; ///< by path: outfits share them
    std::map<std::string, osg::ref_ptr<osg::Node>> _nodes;
};

} // namespace

Result<std::vector<OutfitShare>> readOutfitsFile(const std::string& file, const OutfitReaders& readers)
{
    const Result<std::string> text = readJsonFile(file);
    if (!text) return text.error();
    OutfitReader reader(std::filesystem::path(file).parent_path().string(), readers);
    std::vector<OutfitShare> outfits;
    const Result<void> read = readJson(text.value(), [&](const Json& json) { outfits = reader.read(json); });
    if (!read) return Error{file + ": " + read.error().message};
    return outfits;
}

} // namespace osgGpuAnimation
