// SPDX-License-Identifier: MIT
#include "tool/Commands.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <osg/Version>
#include <osgDB/Callbacks>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::tool
{

namespace
{

constexpr int statusDone = 0;
constexpr int statusFileAtFault = 1;
constexpr int statusWrongUsage = 2;

const char* const anyModel = "A .gltf or .glb, or what Assimp or OSG's plugins read (.fbx, .osgb, scene.osg.gpuanim)";

const char* const description = R"(Looks into animated models as osgGpuAnimation plays them.

  osggpuanim inspect fox.glb                         what is in it: joints, clips, bytes
  osggpuanim render fox.glb -o fox.png               a picture of it, without a display
  osggpuanim render fox.glb --clip Run --frames 48 --fps 24 -o run.png
                                                     run.0001.png ... run.0048.png
  osggpuanim pose fox.glb --clip Walk --time 0.25    where joints and vertices are then, as JSON
  osggpuanim convert fox.fbx --clips run.fbx -o fox.glb
                                                     one file of any model and its clips)";

const char* const exitStatus = "\n\nExit status: 0 done, 1 a file is at fault (the message is on standard error), "
                               "2 wrong usage.";

const char* const inspectHelp =
    R"(Prints: joints and depth of the hierarchy, skins, palette entries (matrices computed on the GPU for each
character), clips, meshes, materials, lights, cameras, extensions, bytes on the GPU, warnings.

  osggpuanim inspect knight.glb
  osggpuanim inspect knight.glb --clips general.glb --clips combat.glb
  osggpuanim inspect knight.glb --json | jq '.clips[].name')";

const char* const poseHelp =
    R"(Writes JSON of the schema gltf-pose/1, with the world matrices of the nodes that are joints (null for
others), joint matrices by skin, morph weights, bounding boxes and vertex positions, in the file's own axes (+Y up),
units and numbers; matrices are column-major. Times beyond the clip hold its ends: nothing loops. One of --time, --bind
and --like is required.

  osggpuanim pose fox.glb --clip Run --time 0 --time 0.25 -o run.json
  osggpuanim pose fox.glb --bind                             the nodes as the file has them, no clip
  osggpuanim pose fox.glb --like oracle.json -o mine.json    clip, times, set weights, vertices of that file
  osggpuanim pose fox.glb --clip 0 --time 1 --evaluator cpu  without a GPU)";

const char* const renderHelp =
    R"(Draws FILE through EGL (by Mesa's software renderer on a machine without a GPU). One camera, in front and to the
side, shows everything in all pictures; with --view, from another direction; with --camera, one of the file's.

  osggpuanim render fox.glb -o fox.png
  osggpuanim render fox.glb --clip Walk --time 0.3 --size 1920x1080 -o walk.png
  osggpuanim render fox.glb --look sun -o sun.png
  osggpuanim render knight.glb --clips combat.glb --clip Block -o block.png
  osggpuanim render fox.glb.20x20.crowd -o foxes.png         400 foxes, each at its own clip and time
  osggpuanim render fox.glb --environment sunset.hdr -o sunset.png
  osggpuanim render fox.glb --frames 60 --fps 30 -o fox.png  fox.0001.png ... fox.0060.png, the first at --time
  osggpuanim render fox.glb --view 90,10 -o left.png         the left side of the fox, from a little above
  osggpuanim render fox.glb --turntable 36 -o turn.png       turn.0001.png ... turn.0036.png, one every 10 degrees

OSG's plugins read scenes (.osg, .osgb, ...) and all pictures for --environment but Radiance HDR. They trust their
files: give them none of unknown origin. Plugins come from the library path alone (OSG_LIBRARY_PATH, the system's
folders), never from the current folder.)";

const char* const convertHelp =
    R"(Writes FILE with its clips, and those of other files for the joints of the same names (retargeted where the rest pose
differs), as one .glb: meshes with skins and morph targets, materials with pictures, markers, lights and cameras; or as
.osgb, .osgt or .osgx, which store all that the kit has. Scenes that OSG reads stay what they are.

  osggpuanim convert knight.fbx --clips run.fbx -o knight.glb
  osggpuanim convert knight.glb --clips general.glb --compact 1e-4 -o knight.osgb
  osggpuanim convert nathan.osg.gpuanim -o nathan.glb)";

std::string checkFinite(const std::string& text)
{
    const bool isFinite = std::isfinite(gltf::parsedNumber<double>(text).value_or(NAN));
    return isFinite ? "" : "'" + text + "' is not a number";
}

std::string checkFraction(const std::string& text)
{
    const std::string fault = checkFinite(text);
    if (!fault.empty()) return fault;
    const double number = gltf::parsedNumber<double>(text).value_or(0.0);
    return number > 0.0 && number <= 1.0 ? "" : "'" + text + "' is not above 0 and at most 1";
}

std::string checkPng(const std::string& name)
{
    return osgDB::getLowerCaseFileExtension(name) == "png" ? "" : "'" + name + "' does not end in .png";
}

std::string checkSceneFile(const std::string& name)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(name);
    for (const char* known : {"glb", "osgb", "osgt", "osgx"})
        if (extension == known) return "";
    return "'" + name + "' does not end in .glb, .osgb, .osgt or .osgx";
}

/// "800x600" to two numbers; throws CLI11's validation error.
void readSize(const std::string& text, RenderCommand& command)
{
    int width = 0, height = 0;
    char rest = '\0';
    const bool isSize = std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &rest) == 2;
    if (!isSize || std::min(width, height) < 1 || std::max(width, height) > RenderCommand::maxSize)
        throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT with numbers from 1 to " +
                                                 std::to_string(RenderCommand::maxSize));
    command.width = width;
    command.height = height;
}

/// "90,10" to a direction; throws CLI11's validation error.
ViewDirection readView(const std::string& text)
{
    ViewDirection view;
    char rest = '\0';
    const bool isPair = std::sscanf(text.c_str(), "%lf,%lf%c", &view.azimuth, &view.elevation, &rest) == 2;
    if (!isPair || !std::isfinite(view.azimuth) || !(std::abs(view.elevation) <= 90.0))
        throw CLI::ValidationError("--view",
                                   "'" + text + "' is not AZIMUTH,ELEVATION with an elevation from -90 to 90");
    return view;
}

/// Adds an option whose values are those words, the default among them being the target's value.
template <class Value>
CLI::Option* addChoice(CLI::App& app, const std::string& name, Value& target,
                       const std::vector<std::pair<std::string, Value>>& choices, const std::string& help)
{
    std::string words;
    for (const auto& choice : choices)
        words += (words.empty() ? "" : "|") + choice.first;
    const auto take = [=, &target](const std::string& word)
    {
        const auto found = std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.first == word; });
        if (found == choices.end()) throw CLI::ValidationError(name, "'" + word + "' is not one of " + words);
        target = found->second;
    };
    return app.add_option_function<std::string>(name, take, help)->option_text(words);
}

/// What is wrong, for people. CLI11 lists all words that it did not take, an unknown option's value and FILE among
/// them.
std::string messageOf(const CLI::ParseError& fault, const CLI::App& app)
{
    const std::vector<std::string> unknown = app.remaining(true);
    const auto option = std::find_if(unknown.begin(), unknown.end(),
                                     [](const std::string& word) { return word.size() > 1 && word.front() == '-'; });
    if (!unknown.empty() && unknown.front().rfind('-', 0) != 0 && app.get_subcommands().empty())
        return "there is no command \"" + unknown.front() + "\"";
    if (option != unknown.end()) return "there is no option " + *option;
    return fault.what();
}

/// --clips FILE, which may be repeated, --clip-joints FILE and --clip-match HOW.
void addClips(CLI::App& command, ModelArguments& arguments)
{
    CLI::Option* clips = command.add_option(
        "--clips", arguments.clips,
        "Add the clips of another file (.gltf, .glb and what Assimp reads), for joints of the same names; repeatable");
    clips->option_text("FILE")->allow_extra_args(false);
    command
        .add_option("--clip-joints", arguments.clipJoints,
                    "Joints and their counterparts in those files, as JSON: {\"Hips\": \"pelvis\"}")
        ->option_text("FILE")
        ->needs(clips);
    addChoice<ClipMatch>(
        command, "--clip-match", arguments.clipMatch, {std::begin(gltf::clipMatches), std::end(gltf::clipMatches)},
        "byName: joints take the transforms of those clips as they are, for files whose rest pose is their first "
        "frame; retarget: their difference from the rest pose; default: auto")
        ->needs(clips);
}

void addCompact(CLI::App& command, double& fraction)
{
    command
        .add_option(
            "--compact", fraction,
            "Compact clips with an error of at most that fraction of the model's longest side, for example 1e-4")
        ->check(checkFraction)
        ->option_text("FRACTION");
}

/// CLI11 from 2.5 on breaks the lines of descriptions and footers anew, those of examples too, unless it is told not
/// to.
template <typename Formatter>
auto keepLines(Formatter& formatter, int) -> decltype(formatter.enable_footer_formatting(false))
{
    formatter.enable_description_formatting(false);
    formatter.enable_footer_formatting(false);
}
template <typename Formatter>
void keepLines(Formatter&, long)
{
}

/// The command line of osggpuanim: its commands, their options and their help.
class CommandLine
{
public:
    CommandLine() : _app(description, "osggpuanim")
    {
        keepLines(*_app.get_formatter(), 0); // which the commands share
        _app.footer(std::string("`osggpuanim COMMAND --help` says more.") + exitStatus);
        _app.set_version_flag("--version", "osggpuanim " OSGGPUANIMATION_VERSION);
        _app.require_subcommand(1);
        _app.allow_windows_style_options(false); // /folder/file is a file there, too
        addInspect();
        addPose();
        addRender();
        addConvert();
    }

    /// Runs the command of the arguments. Exit status: 0 success, 1 a file is at fault, 2 wrong usage.
    int run(int argc, char** argv)
    {
        try
        {
            _app.parse(argc, argv);
            if (_app.got_subcommand("pose") && _pose.like.empty() && !_pose.bind && _pose.times.empty())
                throw CLI::RequiredError("pose: one of --time, --bind and --like");
        }
        catch (const CLI::ParseError& fault)
        {
            if (fault.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return _app.exit(fault); // help
            std::cerr << "osggpuanim: " << messageOf(fault, _app) << "\nRun with --help for more information."
                      << std::endl;
            return statusWrongUsage;
        }
        const Result<void> done = _run();
        if (done) return statusDone;
        std::cerr << "osggpuanim: " << done.error().message << std::endl;
        return statusFileAtFault;
    }

private:
    /// A command with what all have: a help, FILE, --clips and --clip-joints.
    template <typename Command>
    CLI::App& addCommand(const char* name, const char* purpose, const std::string& help, const std::string& file,
                         Command& command)
    {
        CLI::App& app = *_app.add_subcommand(name, purpose);
        app.footer(help + exitStatus);
        app.add_option("FILE", command.file, file)->required();
        addClips(app, command);
        app.callback([this, &command] { _run = [&command] { return command.run(); }; });
        return app;
    }
    void addInspect();
    void addPose();
    void addRender();
    void addConvert();

    CLI::App _app;
    std::function<Result<void>()> _run; ///< the command that was parsed
    InspectCommand _inspect;
    PoseCommand _pose;
    RenderCommand _render;
    ConvertCommand _convert;
};

void CommandLine::addInspect()
{
    CLI::App& app = addCommand("inspect", "What is in a file and what it costs", inspectHelp, anyModel, _inspect);
    app.add_flag("--json", _inspect.json, "JSON, for programs");
    addCompact(app, _inspect.compact);
}

void CommandLine::addPose()
{
    CLI::App& app = addCommand("pose", "Where joints and vertices are at given times", poseHelp, anyModel, _pose);
    CLI::Option* clip = app.add_option("--clip", _pose.clip,
                                       "A clip's name, or an animation's number where none has that name; "
                                       "default: the first clip");
    CLI::Option* time = app.add_option("--time", _pose.times, "Seconds on the clip's own time line; may be repeated")
                            ->check(checkFinite)
                            ->allow_extra_args(false);
    CLI::Option* bind = app.add_flag("--bind", _pose.bind, "No clip: the nodes as the file has them, at time 0");
    CLI::Option* like = app.add_option("--like", _pose.like,
                                       "A gltf-pose/1 document whose clip, times, set weights and vertices are "
                                       "to be taken");
    like->excludes(clip)->excludes(time)->excludes(bind);
    bind->excludes(clip)->excludes(time);
    addChoice<bool>(app, "--evaluator", _pose.onGpu, {{"gpu", true}, {"cpu", false}},
                    "gpu (default): read back from the palette buffer and captured from the skinning shader; "
                    "cpu: the same computed without GL");
    app.add_option("-o,--output", _pose.output, "OUT.json; default: standard output");
}

void CommandLine::addRender()
{
    CLI::App& app = addCommand("render", "Pictures of a file, without a display", renderHelp,
                               std::string(anyModel) + "; or a crowd of it: FILE.20x20.crowd", _render);
    app.add_option("--clip", _render.clip,
                   "A clip's name, or an animation's number where none has that name; default: the first clip");
    app.add_option("--outfits", _render.outfits, "Of a crowd: an outfits file (JSON), or random")
        ->type_name("FILE|random");
    app.add_option("--variant", _render.variant,
                   "A variant of the file's materials: its name, or its number where none has that name; "
                   "default: none");
    CLI::Option* camera =
        app.add_option("--camera", _render.camera,
                       "A camera of the file: its name, or its number where none has that name; default: a "
                       "view of everything");
    app.add_option_function<std::string>(
           "--view", [this](const std::string& text) { _render.view = readView(text); },
           "From where, in degrees: 0,0 is level, in front; azimuth 90 is the model's left side; elevation 90 is "
           "above; "
           "default: about 29,15; crowds from higher")
        ->option_text("AZIMUTH,ELEVATION")
        ->excludes(camera);
    app.add_option("--time", _render.time, "Seconds; clips loop (default 0)")->check(checkFinite);
    app.add_option_function<std::string>(
           "--size", [this](const std::string& text) { readSize(text, _render); }, "WxH in pixels (default 800x600)")
        ->option_text("WxH");
    CLI::Option* frames = app.add_option("--frames", _render.frames, "How many pictures, numbered from 0001")
                              ->check(CLI::Range(1, 1000000));
    app.add_option("--turntable", _render.turntable,
                   "How many pictures around everything, numbered from 0001, the first from --view; the camera moves "
                   "counter-clockwise, seen from above")
        ->check(CLI::Range(1, 1000000))
        ->excludes(frames)
        ->excludes(camera);
    app.add_option("--fps", _render.framesPerSecond, "Pictures a second (default 30)")
        ->check(CLI::Range(0.001, 100000.0))
        ->needs(frames);
    CLI::Option* look = addChoice<Look>(
        app, "--look", _render.look,
        {{"studio", Look::Studio}, {"sun", Look::Sun}, {"furnace", Look::Furnace}, {"file", Look::File}},
        "studio: image-based light with tone mapping; sun: one light and an even surrounding; furnace: a "
        "white surrounding; file: the file's own lights (default studio)");
    app.add_option(
           "--environment", _render.environment,
           "An equirectangular picture in place of the studio; not with --look. Radiance .hdr of any origin; OSG's "
           "plugins read the other formats and trust them")
        ->option_text("FILE")
        ->excludes(look);
    app.add_option("-o,--output", _render.output, "OUT.png")->required()->check(checkPng);
}

void CommandLine::addConvert()
{
    CLI::App& app = addCommand("convert", "A model and its clips as one file", convertHelp,
                               "A model of any format that can be read", _convert);
    addCompact(app, _convert.compact);
    app.add_option("-o,--output", _convert.output, "OUT.glb, .osgb, .osgt or .osgx")->required()->check(checkSceneFile);
}

/// Libraries come from the library path alone. OSG would also open osgPlugins-3.6.5/ in the current folder, where files
/// of any origin may be.
class LibraryPathOnly : public osgDB::FindFileCallback
{
public:
    /// Removes empty elements, which mean the current folder.
    LibraryPathOnly()
    {
        osgDB::FilePathList& folders = osgDB::Registry::instance()->getLibraryFilePathList();
        folders.erase(std::remove(folders.begin(), folders.end(), ""), folders.end());
    }

    std::string findLibraryFile(const std::string& name, const osgDB::Options*, osgDB::CaseSensitivity how) override
    {
        const std::string simple = osgDB::getSimpleFileName(name);
        for (const std::string& folder : {"osgPlugins-" + std::string(osgGetVersion()) + "/", std::string()})
        {
            const std::string found =
                osgDB::findFileInPath(folder + simple, osgDB::Registry::instance()->getLibraryFilePathList(), how);
            if (!found.empty()) return found;
        }
        return "/dev/null/" + simple; // for an empty name OSG would try the current folder; no file is below a device
    }
};

} // namespace

} // namespace osgGpuAnimation::tool

int main(int argc, char** argv)
{
    try
    {
        osgDB::Registry::instance()->setFindFileCallback(new osgGpuAnimation::tool::LibraryPathOnly);
        return osgGpuAnimation::tool::CommandLine().run(argc, argv);
    }
    catch (const std::exception& fault)
    {
        // For example, out of memory.
        std::cerr << "osggpuanim: " << fault.what() << std::endl;
        return 1;
    }
}
