// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/System.h>
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/lod/LevelsTask.h>

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <optional>
#include <thread>

namespace osgGpuAnimation
{

namespace
{

/// function(const SkinnedGeometry&), for the meshes that may have levels.
template <typename Function>
void forEachMeshWithLevels(const osg::Group& meshes, Function function)
{
    std::size_t vertices = 0;
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    vertices += mesh.getVertexCount();
                    if (vertices <= LevelsTask::maxVertices) function(mesh);
                });
}

LodLevels::Skinning skinningOf(const SkinnedGeometry& mesh)
{
    return [&mesh](const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& out)
    { mesh.computePositions(palette, out); };
}

} // namespace

/// What the thread reads and makes. It owns nothing of the application but pictures.
class LevelsTask::Work
{
public:
    struct Mesh
    {
        osg::ref_ptr<const SkinnedGeometry> copy; ///< null after the work
        std::shared_ptr<LodLevels> levels;        ///< of the copy; null: not needed
        bool isMissing;                           ///< false: they have steps from the beginning
    };

    explicit Work(std::shared_ptr<const AnimationSet> set) : _set(std::move(set)) {}

    std::vector<Mesh> meshes;
    std::optional<CharacterLevels::Sources> sources; ///< none: nothing to merge
    std::vector<CharacterLevels::Made> made;         ///< after the work

    void stop() { _stop = true; }
    bool isStopped() const { return _stop; }
    bool isDone() const { return _isDone; }
    /// Concurrent calls wait for the one that does the work.
    void run()
    {
        std::call_once(_begun,
                       [this]
                       {
                           make();
                           _isDone = true;
                       });
    }

private:
    void make()
    {
        CharacterLevels::Sources::Levels levels;
        for (Mesh& mesh : meshes)
        {
            if (mesh.isMissing && !_stop) mesh.levels->addSteps(*mesh.copy, *_set, skinningOf(*mesh.copy), &_stop);
            levels.push_back(mesh.levels);
        }
        if (sources && !_stop) made = sources->make(*_set, levels, &_stop);
        sources.reset();
        for (Mesh& mesh : meshes)
            mesh.copy = nullptr;
    }

    const std::shared_ptr<const AnimationSet> _set;
    std::atomic<bool> _stop{false}, _isDone{false};
    std::once_flag _begun;
};

namespace
{

/// The thread that does work, in the order of its arrival. It begins with the first work.
template <typename Work>
class Worker
{
public:
    static void add(const std::shared_ptr<Work>& work)
    {
        if (isGone()) return; // the process ends; wait() still works
        if constexpr (system::threadsEndBeforeLibraries)
        {
            static Worker* const kept = new Worker; // its thread is gone when it would be destroyed
            kept->append(work);
        }
        else
        {
            static Worker worker;
            worker.append(work);
        }
    }

private:
    Worker() : _thread(&Worker::run, this) {}
    ~Worker()
    {
        isGone() = true;
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _isEnding = true;
            if (_running) _running->stop();
        }
        _changed.notify_one();
        _thread.join();
    }

    static std::atomic<bool>& isGone()
    {
        static std::atomic<bool> is{false};
        return is;
    }

    void append(const std::shared_ptr<Work>& work)
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _queue.push_back(work);
        }
        _changed.notify_one();
    }

    void run()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        while (true)
        {
            _changed.wait(lock, [&] { return _isEnding || !_queue.empty(); });
            if (_isEnding) return;
            _running = std::move(_queue.front());
            _queue.pop_front();
            lock.unlock();
            if (!_running->isStopped()) _running->run();
            lock.lock();
            _running = nullptr;
        }
    }

    std::mutex _mutex;
    std::condition_variable _changed;
    std::deque<std::shared_ptr<Work>> _queue;
    std::shared_ptr<Work> _running;
    bool _isEnding = false;
    std::thread _thread; ///< the last member: it uses the others
};

} // namespace

bool LevelsTask::areMissing(const osg::Group& meshes)
{
    bool areMissing = false;
    forEachMeshWithLevels(meshes, [&](const SkinnedGeometry& mesh)
                          { areMissing = areMissing || !MeshDetail::findLevels(mesh); });
    return areMissing;
}

std::shared_ptr<LevelsTask> LevelsTask::of(const osg::Group& meshes, const std::shared_ptr<const AnimationSet>& set,
                                           bool isMerged, bool keepsParts)
{
    static std::mutex mutex;
    static std::vector<std::weak_ptr<LevelsTask>> tasks;
    const std::lock_guard<std::mutex> lock(mutex);
    tasks.erase(std::remove_if(tasks.begin(), tasks.end(), [](const auto& task) { return task.expired(); }),
                tasks.end());
    for (const std::weak_ptr<LevelsTask>& known : tasks)
    {
        const std::shared_ptr<LevelsTask> task = known.lock();
        if (task && task->isOf(meshes, *set, isMerged)) return task;
    }
    const std::shared_ptr<LevelsTask> task(new LevelsTask(meshes, set, isMerged, keepsParts));
    tasks.push_back(task);
    Worker<Work>::add(task->_work);
    return task;
}

LevelsTask::LevelsTask(const osg::Group& meshes, const std::shared_ptr<const AnimationSet>& set, bool isMerged,
                       bool keepsParts)
    : _set(set), _merged(isMerged ? CharacterLevels::unmade(meshes, *set) : nullptr), _work(std::make_shared<Work>(set))
{
    std::vector<CharacterLevels::Sources::Mesh> sources;
    forEachMeshWithLevels(meshes,
                          [&](const SkinnedGeometry& mesh)
                          {
                              const std::shared_ptr<const LodLevels> known = MeshDetail::findLevels(mesh);
                              const std::shared_ptr<LodLevels> alike = known ? nullptr : levelsLike(mesh);
                              const bool isMissing = !known && !alike, isRead = isMerged || isMissing;
                              const osg::ref_ptr<const SkinnedGeometry> copy =
                                  isRead ? MeshDetail::snapshot(mesh) : nullptr;
                              std::shared_ptr<LodLevels> levels = alike;
                              if (isRead && !alike) levels = std::make_shared<LodLevels>(*copy);
                              if (levels && known) levels->shareSteps(*known);
                              _meshes.push_back({&mesh, MeshDetail::forgetCount(mesh),
                                                 known ? nullptr : std::make_shared<LodLevels>(mesh)});
                              _work->meshes.push_back({copy, levels, isMissing});
                              sources.push_back({&mesh, copy});
                          });
    if (!isMerged) return;
    _work->sources.emplace(sources, keepsParts);
    if (_work->sources->isEmpty()) _work->sources.reset();
}

/// What the thread makes for an earlier mesh with the same arrays, such as a copy in another state; null: there is
/// none.
std::shared_ptr<LodLevels> LevelsTask::levelsLike(const SkinnedGeometry& mesh) const
{
    for (std::size_t i = 0; i < _meshes.size(); ++i)
    {
        const Mesh& known = _meshes[i];
        if (known.levels && known.levels->isOf(mesh) && known.mesh->getEntries(0) == mesh.getEntries(0) &&
            known.mesh->getRigidEntry() == mesh.getRigidEntry())
            return _work->meshes[i].levels;
    }
    return nullptr;
}

LevelsTask::~LevelsTask()
{
    _work->stop();
}

bool LevelsTask::Mesh::isOf(const SkinnedGeometry& present) const
{
    return levels && &present == mesh && forgetCount == MeshDetail::forgetCount(present) && levels->isOf(present);
}

bool LevelsTask::isOf(const osg::Group& meshes, const AnimationSet& set, bool isMerged) const
{
    if (&set != _set.get() || (isMerged && !(_merged && _merged->isOf(meshes, set)))) return false;
    bool isOf = true;
    forEachMeshWithLevels(meshes,
                          [&](const SkinnedGeometry& mesh)
                          {
                              isOf = isOf && (MeshDetail::findLevels(mesh) ||
                                              std::any_of(_meshes.begin(), _meshes.end(),
                                                          [&](const Mesh& own) { return own.isOf(mesh); }));
                          });
    return isOf;
}

bool LevelsTask::isDone() const
{
    return _work->isDone();
}

void LevelsTask::wait()
{
    _work->run();
}

std::shared_ptr<const CharacterLevels> LevelsTask::take()
{
    const std::lock_guard<std::mutex> lock(_takeMutex);
    if (!_isTaken && !_work->isStopped())
    {
        for (std::size_t i = 0; i < _meshes.size(); ++i)
        {
            const Mesh& own = _meshes[i];
            if (!own.isOf(*own.mesh)) continue;
            own.levels->shareSteps(*_work->meshes[i].levels);
            MeshDetail::setLevels(const_cast<SkinnedGeometry&>(*own.mesh), own.levels);
        }
        if (_merged) _merged->includeMade(std::move(_work->made));
        _isTaken = true;
    }
    // Owners of the levels keep the task, so that of() finds it for other nodes.
    return _merged ? std::shared_ptr<const CharacterLevels>(shared_from_this(), _merged.get()) : nullptr;
}

} // namespace osgGpuAnimation
