// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/characters/FirstDraw.h>

#include <osgGpuAnimation/gpu/passes/FeedbackTimer.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/mesh/draw/InstancedDraw.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/UserDataContainer>
#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using StateSets = std::vector<osg::ref_ptr<osg::StateSet>>;

void addStateSet(const osg::Node& node, StateSets& stateSets)
{
    if (node.getStateSet()) stateSets.emplace_back(const_cast<osg::StateSet*>(node.getStateSet()));
}

/// The state that osgUtil::SceneView begins with, in a viewer without lights in the scene.
osg::ref_ptr<osg::StateSet> viewState()
{
    osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
    stateSet->setGlobalDefaults();
    stateSet->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    stateSet->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    return stateSet;
}

/// True if culling the node adds no state, as that of effects, shadows, surroundings and nested characters does.
bool isPlain(const osg::Node& node)
{
    const osg::Callback* callback = node.getCullCallback();
    const bool isOfFile = dynamic_cast<const ViewLightsCallback*>(callback) && !callback->getNestedCallback();
    return node.libraryName() == std::string("osg") && (!callback || isOfFile);
}

/// True if the frame will draw below these nodes with their state sets and a headlight: all are plain, and no light of
/// the scene is on. Programs for other state would be compiled in vain.
bool hasKnownState(const osg::NodePath& path, const osg::Node& character)
{
    for (const osg::Node* node : path)
    {
        if (node != &character && !isPlain(*node)) return false;
        const osg::StateSet* stateSet = node->getStateSet();
        for (GLenum light = GL_LIGHT0; stateSet && light <= GL_LIGHT7; ++light)
            if (stateSet->getMode(light) & osg::StateAttribute::ON) return false;
    }
    return true;
}

/// A mesh with the state sets that apply to it, from the root on.
struct StatedMesh
{
    osg::ref_ptr<SkinnedGeometry> mesh;
    StateSets stateSets;
};

/// The meshes below a character, with the state sets of the nodes down to them; one mesh for each state. Nothing below
/// nodes that add state when they are culled.
class MeshCollector : public SceneVisitor
{
public:
    using SceneVisitor::apply;
    /// isInstanced: only the meshes of instanced draws.
    MeshCollector(StateSets above, bool isInstanced)
        : SceneVisitor(Shared::EachPath, TRAVERSE_ACTIVE_CHILDREN), _above(std::move(above)), _isInstanced(isInstanced)
    {
    }

    void apply(osg::Node& node) override
    {
        if (getNodePath().size() == 1 || isPlain(node)) traverse(node);
    }

    void apply(osg::Drawable& drawable) override
    {
        auto* mesh = dynamic_cast<SkinnedGeometry*>(&drawable);
        // There is no view that a callback may expect.
        if (!mesh || mesh->getDrawCallback() || mesh->getCullCallback()) return;
        const bool isChild = getNodePath().size() == 2;
        if (_isInstanced && !(isChild && canBeDrawnTogether(*mesh))) return;
        StatedMesh found{mesh, _above};
        for (const osg::Node* node : getNodePath())
            addStateSet(*node, found.stateSets);
        if (_known.emplace(found.stateSets, mesh->getColors()).second) meshes.push_back(std::move(found));
    }

    std::vector<StatedMesh> meshes;

private:
    StateSets _above;
    bool _isInstanced;
    std::set<std::pair<StateSets, SkinnedGeometry::Colors>> _known;
};

/// The drawable that visitors compile. Not DYNAMIC, and with vertex buffers: visitors compile only such drawables.
class FirstDraw : public osg::Drawable
{
public:
    FirstDraw(const DrawnCharacter& character, std::vector<StatedMesh> meshes, bool isInstanced)
        : _set(character.controller.sharedSet()), _batch(_set), _meshes(std::move(meshes)), _isInstanced(isInstanced)
    {
        setName("osgGpuAnimation FirstDraw");
        setUseDisplayList(false);
        setUseVertexBufferObjects(true);
        _batch.setRootMatrix(character.rootMatrix);
        _batch.add(character.controller.instruction());
    }

    void drawImplementation(osg::RenderInfo&) const override {}

    void compileGLObjects(osg::RenderInfo& renderInfo) const override
    {
        osg::State& state = *renderInfo.getState();
        // Another thread may draw in a context of the same number.
        if (MeshVertexArrays::isNumberShared(state)) return;
        PosePipeline* pipeline = PosePipeline::of(state);
        if (!pipeline) return;
        DeletionLists::make(state);
        if (pipeline->place(*_set, 0, 0).texture == 0 && !pipeline->evaluateInEachForm(state, _batch, 0)) return;
        const unsigned int stackSize = state.getStateSetStackSize();
        const osg::ref_ptr<osg::StateSet> view = viewState(), frame = frameState();
        for (const StatedMesh& each : _meshes)
        {
            state.pushStateSet(view);
            for (const osg::ref_ptr<osg::StateSet>& stateSet : each.stateSets)
                state.pushStateSet(stateSet);
            state.pushStateSet(frame);
            if (osg::StateSet* ofMesh = each.mesh->meshState()) state.pushStateSet(ofMesh);
            state.apply();
            each.mesh->draw(renderInfo);
            state.popStateSetStackToSize(stackSize);
        }
        // OSG remembers the applied attributes by their addresses, and those of the view and the frames go.
        state.apply();
        state.applyMode(GL_RASTERIZER_DISCARD, false); // before the next frame clears
        state.get<osg::GLExtensions>()->glUseProgram(0);
        state.setLastAppliedProgramObject(nullptr);
        state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
        state.haveAppliedAttribute(PaletteBinding::bindingType);
    }

protected:
    ~FirstDraw() override = default;

private:
    /// As of PoseFrame in a cull traversal.
    osg::ref_ptr<osg::StateSet> frameState() const
    {
        osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
        osg::ref_ptr<PaletteBinding> binding = new PaletteBinding;
        if (_isInstanced)
        {
            binding->setInstanced(_set, 0);
            binding->add(std::make_shared<const std::vector<InstanceTransform>>(1));
            stateSet->setDefine("POSE_INSTANCED");
        }
        else
            binding->set(_set, 0, 0);
        stateSet->setAttribute(binding);
        stateSet->setMode(GL_RASTERIZER_DISCARD, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
        return stateSet;
    }

    std::shared_ptr<const AnimationSet> _set;
    PoseBatch _batch; ///< one instance
    std::vector<StatedMesh> _meshes;
    bool _isInstanced;
};

/// The drawables of one visitor, which knows them by their addresses.
class FirstDraws : public osg::Object
{
public:
    FirstDraws() = default;
    FirstDraws(const FirstDraws& other, const osg::CopyOp& copyop) : osg::Object(other, copyop), ofSets(other.ofSets) {}
    META_Object(osgGpuAnimation, FirstDraws)

    static FirstDraws& of(osg::NodeVisitor& visitor)
    {
        osg::UserDataContainer* container = visitor.getOrCreateUserDataContainer();
        for (unsigned int i = 0; i < container->getNumUserObjects(); ++i)
            if (auto* known = dynamic_cast<FirstDraws*>(container->getUserObject(i))) return *known;
        const osg::ref_ptr<FirstDraws> made = new FirstDraws;
        container->addUserObject(made);
        return *made;
    }

    std::unordered_map<const AnimationSet*, std::vector<osg::ref_ptr<FirstDraw>>> ofSets;

protected:
    ~FirstDraws() override = default;
};

/// True if the visitor compiles GL objects, now or later.
bool isCompiling(osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() != osg::NodeVisitor::NODE_VISITOR) return false;
    if (auto* compiler = dynamic_cast<osgUtil::GLObjectsVisitor*>(&visitor))
        return compiler->getState() && (compiler->getMode() & osgUtil::GLObjectsVisitor::COMPILE_DISPLAY_LISTS);
    const auto* collector = dynamic_cast<osgUtil::StateToCompile*>(&visitor);
    return collector && (collector->_mode & osgUtil::GLObjectsVisitor::COMPILE_DISPLAY_LISTS);
}

} // namespace

void prepareFirstDraw(osg::NodeVisitor& visitor, const DrawnCharacter& character)
{
    if (!isCompiling(visitor)) return;
    std::vector<osg::ref_ptr<FirstDraw>>& known = FirstDraws::of(visitor).ofSets[&character.controller.set()];
    if (known.size() == 2 || (known.size() == 1 && !character.isDrawnTogether)) return;
    StateSets above;
    for (const osg::Node* node : visitor.getNodePath())
        if (node != &character.node) addStateSet(*node, above);
    const bool isInstanced = known.size() == 1;
    MeshCollector collector(std::move(above), isInstanced);
    if (hasKnownState(visitor.getNodePath(), character.node)) character.node.accept(collector);
    known.push_back(new FirstDraw(character, std::move(collector.meshes), isInstanced));
    visitor.apply(static_cast<osg::Drawable&>(*known.back()));
}

} // namespace osgGpuAnimation
