// SPDX-License-Identifier: MIT
// Usage: soak [--seconds N] [--seed S] [--field COUNT] [--outfits OUTFITS.json] FILE
// With the file's character, clones, removes, changes clips, moves the cameras, changes the window's size and the
// threading model: at random, but the same for the same seed. A field is a crowd of that many instances with levels of
// detail, of which every frame replaces, moves and redirects 1 %, and dresses 1 % in another outfit; now and then an
// outfit changes. Prints GL errors and the growth of allocated memory
// since the first minute, measured with the window closed and the scene empty but for the field. Exit status 0: no GL
// error, and at most 2 % growth.
#include "support/ThreadingModels.h"

#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/OutfitsFile.h>

#include <osg/ArgumentParser>
#include <osgDB/ReadFile>
#include <osgViewer/Viewer>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iostream>
#include <malloc.h>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace
{

using namespace osgGpuAnimation;

constexpr unsigned int maxClones = 60;
constexpr std::size_t maxInstances = 200;

/// A member of a list at random.
template <typename List>
auto& anyOf(List& list, std::mt19937& random)
{
    return list[std::uniform_int_distribution<std::size_t>(0, std::size(list) - 1)(random)];
}

bool oneOf(int count, std::mt19937& random)
{
    return std::uniform_int_distribution<int>(1, count)(random) == 1;
}

/// A scene that changes between frames: characters are cloned from a model and removed, crowd instances are added and
/// removed, clips change. Beside them a field of instances keeps its number.
class SoakScene
{
public:
    /// model: contains a character; it is not changed. outfits: of the field.
    SoakScene(osg::ref_ptr<osg::Node> model, std::size_t fieldCount, const std::vector<OutfitShare>& outfits,
              std::mt19937& random)
        : _random(random), _model(model), _crowd(new AnimatedCrowd(*findCharacter(*model))),
          _field(new AnimatedCrowd(*findCharacter(*model)))
    {
        for (osg::Node* child : std::initializer_list<osg::Node*>{_clones, _crowd, _field})
            root->addChild(child);
        const double density = std::max(1.0, static_cast<double>(fieldCount) / maxInstances);
        _reach = 15.0 * _model->getBound().radius() * std::sqrt(density);
        static_cast<void>(_field->getMeshes().setPixelError(0.5f)); // in range
        for (const OutfitShare& each : outfits)
        {
            if (const Result<void> added = _field->getOutfits().add(each.outfit); !added)
                std::cerr << added.error().message << std::endl;
            else
                _outfits.push_back(each.outfit);
        }
        while (_fieldInstances.size() < fieldCount)
            _fieldInstances.push_back(addTo(*_field));
        _field->getMeshes().waitForLevels(); // they count as memory from the beginning
    }

    void change()
    {
        changeClones();
        changeCrowd();
        changeField();
    }

    /// Removes everything but the field.
    void clear()
    {
        _clones->removeChildren(0, _clones->getNumChildren());
        for (const AnimatedCrowd::Instance instance : _instances)
            _crowd->remove(instance);
        _instances.clear();
    }

    const osg::ref_ptr<osg::Group> root = new osg::Group;

private:
    osg::Matrixd randomPlace()
    {
        std::uniform_real_distribution<double> along(-_reach, _reach);
        const double x = along(_random);
        return osg::Matrixd::translate(x, along(_random), 0.0);
    }

    void changeClip(AnimationController& controller)
    {
        if (controller.set().clips().empty()) return;
        const std::string& name = anyOf(controller.set().clips(), _random).name();
        static_cast<void>(oneOf(2, _random) ? controller.crossfade(name, 0.3) : controller.play(name)); // it is there
        controller.setSpeed(std::uniform_real_distribution<double>(0.5, 2.0)(_random));
    }

    void changeClones()
    {
        if (oneOf(2, _random) && _clones->getNumChildren() < maxClones)
        {
            osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(randomPlace());
            place->addChild(osg::clone(_model.get(), osg::CopyOp::DEEP_COPY_NODES));
            _clones->addChild(place);
        }
        else if (_clones->getNumChildren() > 0)
            _clones->removeChild(anyClone());
        if (_clones->getNumChildren() > 0) changeClip(findCharacter(*_clones->getChild(anyClone()))->getController());
    }

    unsigned int anyClone()
    {
        return std::uniform_int_distribution<unsigned int>(0, _clones->getNumChildren() - 1)(_random);
    }

    void changeCrowd()
    {
        if (!_instances.empty() && (oneOf(3, _random) || _instances.size() >= maxInstances))
        {
            AnimatedCrowd::Instance& removed = anyOf(_instances, _random);
            _crowd->remove(removed);
            removed = _instances.back();
            _instances.pop_back();
        }
        else
            _instances.push_back(addTo(*_crowd));
        if (!_instances.empty()) changeClip(*_crowd->getController(anyOf(_instances, _random)));
    }

    void changeField()
    {
        for (std::size_t change = 0; change < _fieldInstances.size() / 100; ++change)
        {
            AnimatedCrowd::Instance& replaced = anyOf(_fieldInstances, _random);
            _field->remove(replaced);
            replaced = addTo(*_field);
            static_cast<void>(_field->setPlacement(anyOf(_fieldInstances, _random), randomPlace())); // it is there
            changeClip(*_field->getController(anyOf(_fieldInstances, _random)));
            dress(anyOf(_fieldInstances, _random));
        }
        if (!_outfits.empty() && oneOf(200, _random)) changeOutfit(anyOf(_outfits, _random));
    }

    void dress(AnimatedCrowd::Instance instance)
    {
        if (_outfits.empty()) return;
        static_cast<void>(_field->setOutfit(instance, anyOf(_outfits, _random))); // both are there
    }

    /// Another object with other colours.
    void changeOutfit(osg::ref_ptr<Outfit>& outfit)
    {
        const osg::ref_ptr<Outfit> changed = osg::clone(outfit.get(), osg::CopyOp::SHALLOW_COPY);
        std::uniform_real_distribution<float> channel(0.0f, 1.0f);
        for (const auto& [material, color] : outfit->getColors())
            changed->setColor(material, osg::Vec4(channel(_random), color.g(), color.b(), 1.0f));
        static_cast<void>(_field->getOutfits().replace(outfit, changed)); // it fits as the first
        outfit = changed;
    }

    AnimatedCrowd::Instance addTo(AnimatedCrowd& crowd)
    {
        AnimationController controller(crowd.getSharedAnimationSet());
        changeClip(controller);
        return crowd.add(randomPlace(), controller).value(); // the place is finite, the set the crowd's
    }

    std::mt19937& _random;
    osg::ref_ptr<osg::Node> _model;
    osg::ref_ptr<osg::Group> _clones = new osg::Group;
    osg::ref_ptr<AnimatedCrowd> _crowd;
    std::vector<AnimatedCrowd::Instance> _instances;
    osg::ref_ptr<AnimatedCrowd> _field;
    std::vector<AnimatedCrowd::Instance> _fieldInstances;
    std::vector<osg::ref_ptr<Outfit>> _outfits;
    double _reach; ///< of places along x and y
};

class ErrorCount : public osg::Camera::DrawCallback
{
public:
    explicit ErrorCount(std::atomic<int>& errors) : _errors(errors) {}
    void operator()(osg::RenderInfo&) const override
    {
        for (int kept = 0; kept < 32 && glGetError() != GL_NO_ERROR; ++kept)
            ++_errors;
    }

private:
    std::atomic<int>& _errors;
};

/// Draws a scene without a display, by two cameras side by side, while the window's size, the cameras and the threading
/// model change. One viewer for all windows: osgViewer never frees a few hundred bytes per viewer (its list of Scenes).
class SoakViewer
{
public:
    SoakViewer(osg::Group& scene, std::mt19937& random) : _random(random), _scene(&scene)
    {
        _viewer->setKeyEventSetsDone(0);
        _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        for (osg::Camera* camera : {_viewer->getCamera(), _second.get()})
            camera->setFinalDrawCallback(new ErrorCount(_glErrors));
        _viewer->addSlave(_second, osg::Matrixd(), osg::Matrixd::rotate(osg::DegreesToRadians(50.0), osg::Y_AXIS));
        _viewer->setSceneData(_scene);
    }
    ~SoakViewer() { close(); }

    /// Opens a window of some size. False: no GL.
    bool open()
    {
        std::uniform_int_distribution<int> size(100, 500);
        const int width = size(_random), height = size(_random), half = width / 2;
        const Result<osg::ref_ptr<osg::GraphicsContext>> window = createOffscreenContext(width, height);
        if (!window)
        {
            std::cerr << window.error().message << std::endl;
            return false;
        }
        _window = window.value();
        osg::Camera& camera = *_viewer->getCamera();
        camera.setGraphicsContext(_window);
        camera.setViewport(0, 0, half, height);
        camera.setProjectionMatrixAsPerspective(40.0, double(half) / height, 1.0, 10000.0);
        _second->setGraphicsContext(_window);
        _second->setViewport(half, 0, width - half, height);
        _viewer->realize();
        return _viewer->isRealized();
    }

    void close()
    {
        if (!_window) return;
        _viewer->stopThreading();
        _window->close();
        for (osg::Camera* camera : {_viewer->getCamera(), _second.get()})
            camera->setGraphicsContext(nullptr);
        _window = nullptr;
    }

    void frame(double time) { _viewer->frame(time); }

    void moveCamera()
    {
        std::uniform_real_distribution<double> way(-1.0, 1.0);
        const double x = way(_random), y = way(_random);
        look(osg::Vec3d(x, y, 0.3 + 0.2 * way(_random)), osg::Z_AXIS);
    }

    void changeThreading() { _viewer->setThreadingModel(anyOf(threadingModels, _random)); }

    /// Draws everything, since cameras and batches keep memory for what they drew; with draw threads a camera keeps two
    /// frames.
    void settle(double time)
    {
        _viewer->setThreadingModel(osgViewer::ViewerBase::DrawThreadPerContext);
        look(osg::Vec3d(0.0, 0.0, 40.0), osg::Y_AXIS);
        for (int frames = 0; frames < 3; ++frames)
            _viewer->frame(time);
    }

    int glErrors() const { return _glErrors; }

private:
    /// from: from the scene's centre, in its radii.
    void look(const osg::Vec3d& from, const osg::Vec3d& up)
    {
        const osg::BoundingSphere bound = _scene->getBound();
        _viewer->getCamera()->setViewMatrixAsLookAt(bound.center() + from * bound.radius(), bound.center(), up);
    }

    std::mt19937& _random;
    std::atomic<int> _glErrors{0};
    osg::ref_ptr<osg::Group> _scene;
    osg::ref_ptr<osgViewer::Viewer> _viewer = new osgViewer::Viewer;
    osg::ref_ptr<osg::Camera> _second = new osg::Camera; ///< a slave of the viewer's camera, looks another way
    osg::ref_ptr<osg::GraphicsContext> _window;
};

struct Arguments
{
    double seconds = 600.0;
    unsigned int seed = 1;
    unsigned int field = 0; ///< instances
    std::string outfits;    ///< of the field; empty: none
    std::string file;
};

bool parse(int count, char** words, Arguments& arguments)
{
    osg::ArgumentParser parser(&count, words);
    parser.read("--seconds", arguments.seconds);
    parser.read("--seed", arguments.seed);
    parser.read("--field", arguments.field);
    parser.read("--outfits", arguments.outfits);
    if (parser.argc() == 2) arguments.file = parser[1];
    return !arguments.file.empty() && arguments.seconds > 0.0 && arguments.field <= AnimatedCrowd::maxInstances;
}

/// Bytes that are allocated and not freed. Resident memory is less precise: it is twenty times as large, mostly
/// libraries, and varies by a tenth with the memory that malloc keeps for ended threads. With an open window llvmpipe's
/// lists of triangles would dominate and vary likewise.
std::size_t allocatedBytes()
{
    const struct mallinfo2 all = mallinfo2();
    return all.uordblks + all.hblkhd;
}

/// 0 if there are no values. Not the median: memory at rest with a field varies by some 5 % from window to window.
double mean(const std::vector<std::size_t>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(1, values.size()));
}

int soak(const Arguments& arguments, osg::ref_ptr<osg::Node> model)
{
    std::mt19937 random(arguments.seed);
    std::vector<OutfitShare> outfits;
    if (!arguments.outfits.empty())
    {
        Result<std::vector<OutfitShare>> read = readOutfitsFile(arguments.outfits);
        if (!read)
        {
            std::cerr << read.error().message << std::endl;
            return 2;
        }
        outfits = std::move(read).value();
    }
    SoakScene scene(model, arguments.field, outfits, random);
    const unsigned int framesOfAWindow = arguments.field > 10000 ? 20 : 200; // a field's take long
    SoakViewer viewer(*scene.root, random);
    if (!viewer.open()) return 1;
    const osg::Timer timer;
    const double warmUp = std::min(60.0, arguments.seconds / 3);
    std::vector<std::size_t> atRest, atRestAtFirst; // with the window closed and the scene empty but for the field
    unsigned int frame = 0;
    while (timer.time_s() < arguments.seconds)
    {
        scene.change();
        if (frame % 7 == 0) viewer.moveCamera();
        if (frame % 20 == 0) viewer.changeThreading();
        viewer.frame(frame / 60.0);
        if (++frame % framesOfAWindow != 0) continue;
        viewer.settle(frame / 60.0);
        viewer.close();
        scene.clear();
        const double seconds = timer.time_s();
        const std::size_t bytes = allocatedBytes();
        (seconds < warmUp ? atRestAtFirst : atRest).push_back(bytes);
        std::cout << static_cast<int>(seconds) << " s, " << frame << " frames, " << bytes << " bytes at rest, "
                  << viewer.glErrors() << " GL errors" << std::endl;
        if (!viewer.open()) return 1;
    }
    const double before = mean(atRestAtFirst), after = mean(atRest);
    const double growth = before > 0.0 ? 100.0 * (after - before) / before : 100.0;
    std::cout << frame << " frames, " << viewer.glErrors() << " GL errors, mean memory at rest in the first "
              << static_cast<int>(warmUp) << " s " << before << " bytes, afterwards " << after << " bytes: " << growth
              << " %" << std::endl;
    return viewer.glErrors() == 0 && growth <= 2.0 ? 0 : 1;
}

} // namespace

int main(int count, char** words)
{
    Arguments arguments;
    if (!parse(count, words, arguments))
    {
        std::cerr << "Usage: soak [--seconds N] [--seed S] [--field COUNT] [--outfits OUTFITS.json] FILE" << std::endl;
        return 2;
    }
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(arguments.file);
    if (!model || !findCharacter(*model))
    {
        std::cerr << arguments.file << " holds no animated character" << std::endl;
        return 2;
    }
    return soak(arguments, model);
}
