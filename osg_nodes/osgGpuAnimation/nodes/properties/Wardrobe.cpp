// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/Wardrobe.h>

#include <osgGpuAnimation/authoring/retarget/JointNames.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osg/ValueObject>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace osgGpuAnimation
{

namespace
{

const char* const garmentKey = "osgGpuAnimation.garment";

void addOnce(std::vector<std::string>& names, const std::string& name)
{
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// function(std::size_t entry), for each influence with a weight.
template <typename Function>
void forEachEntry(const SkinnedGeometry& mesh, Function function)
{
    for (std::size_t vertex = 0; vertex < mesh.getVertexCount(); ++vertex)
        mesh.forEachInfluence(vertex, [&](std::size_t entry, float) { function(entry); });
}

double maxVertexDistance(const std::vector<const SkinnedGeometry*>& meshes)
{
    double max = 0.0;
    for (const SkinnedGeometry* mesh : meshes)
        if (const auto* vertices = dynamic_cast<const osg::Vec3Array*>(mesh->getVertexArray()))
            for (const osg::Vec3& vertex : *vertices)
                max = std::max(max, static_cast<double>(vertex.length()));
    return max;
}

/// True if the matrices move no point within the radius around the origin to places that differ by more than
/// 1 / 100,000 of the radius, in the units of joint space: exporters round inverse binds differently.
bool bindAlike(const AffineMatrix& one, const AffineMatrix& other, double radius)
{
    constexpr double tolerance = 1e-5;
    double linear = 0.0, difference = 0.0, shift = 0.0;
    for (std::size_t row = 0; row < 3; ++row)
    {
        const glm::dvec4 a(one.rows[row]), b(other.rows[row]), d = a - b;
        linear += glm::dot(glm::dvec3(a), glm::dvec3(a));
        difference += glm::dot(glm::dvec3(d), glm::dvec3(d));
        shift += d.w * d.w;
    }
    return std::sqrt(difference) * radius + std::sqrt(shift) <= tolerance * std::sqrt(linear) * radius;
}

/// Finds the palette entries of a body for those of a garment.
class Fitter
{
public:
    Fitter(const AnimationSet& garment, const std::vector<const SkinnedGeometry*>& meshes, const AnimationSet& body)
        : _garment(garment), _body(body),
          _joints(findCounterparts(namesIn(garment.skeleton().joints()), namesIn(body.skeleton().joints()), {})),
          _radius(maxVertexDistance(meshes)), _entries(garment.paletteSize(), -1)
    {
        std::vector<bool> isUsed(garment.paletteSize(), false);
        for (const SkinnedGeometry* mesh : meshes)
            forEachEntry(*mesh,
                         [&](std::size_t entry)
                         {
                             if (entry < isUsed.size()) isUsed[entry] = true;
                         });
        for (std::size_t entry = 0; entry < isUsed.size(); ++entry)
            if (isUsed[entry] && garment.palette()[entry].joint >= 0) place(entry, garment.palette()[entry]);
    }

    /// Error: joints without a counterpart that have none above them.
    Result<FittedGarment> fit(const std::shared_ptr<const AnimationSet>& body) const
    {
        if (!_lost.empty())
            return Error{"the character has no joints " + quotedNames(_lost) +
                         ", nor any joint that is above them in the garment; its joints are " +
                         quotedNames(body->skeleton().joints())};
        FittedGarment fitted{{_further.joints.size(), _followed, {}}, body, {}};
        if (_further.joints.empty()) return fitted;
        constexpr std::size_t maxEntries = 65536; // entries are 16-bit numbers
        if (body->paletteSize() + _further.joints.size() > maxEntries)
            return Error{"the palette would have " + std::to_string(body->paletteSize() + _further.joints.size()) +
                         " entries, more than " + std::to_string(maxEntries)};
        std::vector<Skin> garments = body->garments();
        garments.push_back(_further);
        Result<std::shared_ptr<const AnimationSet>> set = body->withGarments(std::move(garments));
        if (!set) return set.error();
        fitted.set = set.value();
        return fitted;
    }

    /// For an entry of the garment that some vertex uses; 0 for others.
    unsigned short entry(std::size_t ofGarment) const
    {
        const int found = ofGarment < _entries.size() ? _entries[ofGarment] : 0;
        return static_cast<unsigned short>(std::max(found, 0));
    }

private:
    void place(std::size_t entry, const PaletteEntry& source)
    {
        const Skeleton& skeleton = _garment.skeleton();
        AffineMatrix inverseBind = source.inverseBind;
        int joint = source.joint;
        for (; joint >= 0 && counterpart(joint) < 0; joint = skeleton.joint(static_cast<std::size_t>(joint)).parent)
            inverseBind = skeleton.joint(static_cast<std::size_t>(joint)).rest.toMatrix() * inverseBind;
        const std::string& name = skeleton.joint(static_cast<std::size_t>(source.joint)).name;
        if (joint < 0) return addOnce(_lost, name);
        if (joint != source.joint) addOnce(_followed, name);
        _entries[entry] = entryFor(counterpart(joint), inverseBind);
    }

    int counterpart(int joint) const { return _joints[static_cast<std::size_t>(joint)]; }

    int entryFor(int joint, const AffineMatrix& inverseBind)
    {
        const std::vector<PaletteEntry>& palette = _body.palette();
        for (std::size_t e = 0; e < palette.size(); ++e)
            if (palette[e].joint == joint && bindAlike(inverseBind, palette[e].inverseBind, _radius))
                return static_cast<int>(e);
        std::size_t place = 0;
        while (place < _further.joints.size() &&
               (_further.joints[place] != joint || !bindAlike(inverseBind, _further.inverseBinds[place], _radius)))
            ++place;
        if (place == _further.joints.size())
        {
            _further.joints.push_back(joint);
            _further.inverseBinds.push_back(inverseBind);
        }
        return static_cast<int>(palette.size() + place);
    }

    const AnimationSet& _garment;
    const AnimationSet& _body;
    std::vector<int> _joints; ///< by joint of the garment: the body's; -1: none
    double _radius;           ///< of the vertices around the origin
    std::vector<int> _entries;
    Skin _further{"garment", {}, {}};
    std::vector<std::string> _followed, _lost;
};

void setEntries(SkinnedGeometry& mesh, const SkinnedGeometry& source, const Fitter& fitter)
{
    if (source.getRigidEntry() >= 0)
        return mesh.setRigidEntry(fitter.entry(static_cast<std::size_t>(source.getRigidEntry())));
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets && source.getEntries(i) && source.getWeights(i); ++i)
    {
        osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(*source.getEntries(i));
        // The buffer object of the garment's arrays may be in use by a thread that draws.
        entries->setVertexBufferObject(new osg::VertexBufferObject);
        for (osg::Vec4us& ofVertex : *entries)
            for (int influence = 0; influence < 4; ++influence)
                ofVertex[influence] = fitter.entry(ofVertex[influence]);
        mesh.setInfluences(i, entries, const_cast<osg::Vec4Array*>(source.getWeights(i)));
    }
}

/// The body's morph of the same name and number of weights; -1: none.
int morphLike(const AnimationSet& body, const MorphWeights& morph)
{
    for (std::size_t m = 0; m < body.morphs().size(); ++m)
        if (body.morphs()[m].name == morph.name && body.morphs()[m].defaults.size() == morph.defaults.size())
            return static_cast<int>(m);
    return -1;
}

void setMorphs(SkinnedGeometry& mesh, const SkinnedGeometry& source, const AnimationSet& garment, FittedGarment& fitted)
{
    if (source.getMorphTargets().empty()) return;
    const auto number = static_cast<std::size_t>(source.getMorph()); // -1 becomes huge
    const MorphWeights morph = number < garment.morphs().size() ? garment.morphs()[number] : MorphWeights();
    const int counterpart = morphLike(*fitted.set, morph);
    if (counterpart >= 0)
        return mesh.setMorphTargets(*fitted.set, static_cast<std::size_t>(counterpart), source.getMorphTargets());
    mesh.setMorphTargets(-1, -1, {});
    addOnce(fitted.leftOut, morph.name);
}

std::string randomIdentifier()
{
    std::random_device random;
    std::ostringstream text;
    text << std::hex << random() << '-' << random();
    return text.str();
}

template <typename ObservedMeshes>
bool areSame(const ObservedMeshes& known, const Wardrobe::Meshes& meshes)
{
    return std::equal(known.begin(), known.end(), meshes.begin(), meshes.end(),
                      [](const auto& one, const SkinnedGeometry* other) { return one.get() == other; });
}

template <typename ObservedMeshes>
bool exist(const ObservedMeshes& known)
{
    return std::all_of(known.begin(), known.end(), [](const auto& mesh) { return mesh.valid(); });
}

} // namespace

bool Wardrobe::Fitting::restore(FittedGarment& out) const
{
    out = fitted;
    out.set = set.lock();
    for (const osg::observer_ptr<SkinnedGeometry>& mesh : meshes)
    {
        osg::ref_ptr<SkinnedGeometry> present;
        if (!mesh.lock(present)) return false;
        out.meshes.push_back(present);
    }
    return out.set != nullptr;
}

Result<FittedGarment> Wardrobe::fit(const osg::Node& garment, const AnimationSet& set,
                                    const std::vector<const SkinnedGeometry*>& meshes,
                                    const std::shared_ptr<const AnimationSet>& body)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const std::string identifier = identifierFor(garment, meshes);
    for (auto known = _fittings.begin(); known != _fittings.end();)
    {
        FittedGarment fitted;
        const bool exists = known->restore(fitted);
        if (exists && known->identifier == identifier && areSame(known->sources, meshes) && known->body.lock() == body)
            return fitted;
        known = exists ? std::next(known) : _fittings.erase(known);
    }
    const Fitter fitter(set, meshes, *body);
    Result<FittedGarment> made = fitter.fit(body);
    if (!made) return made;
    FittedGarment fitted = made.value();
    UnanimatedMeshes unanimated(set);
    for (const SkinnedGeometry* source : meshes)
    {
        const osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry(*source, osg::CopyOp::SHALLOW_COPY);
        unanimated.release(*mesh);
        // A garment may wear garments itself. VariantMeshes tells meshes apart by their own user data.
        removeMark(*mesh, garmentKey);
        mesh->setUserValue(garmentKey, identifier);
        setEntries(*mesh, *source, fitter);
        setMorphs(*mesh, *source, set, fitted);
        fitted.meshes.push_back(mesh);
    }
    _fittings.push_back({identifier,
                         {meshes.begin(), meshes.end()},
                         body,
                         fitted.set,
                         {fitted.meshes.begin(), fitted.meshes.end()},
                         {fitted, nullptr, {}}});
    return fitted;
}

const Wardrobe::Garment* Wardrobe::find(const osg::Node& garment, const Meshes& meshes) const
{
    const auto isIt = [&](const Garment& known)
    { return known.node.get() == &garment || areSame(known.meshes, meshes); };
    const auto known = std::find_if(_garments.begin(), _garments.end(), isIt);
    return known == _garments.end() ? nullptr : &*known;
}

std::string Wardrobe::identifierFor(const osg::Node& garment, const Meshes& meshes)
{
    if (const Garment* known = find(garment, meshes)) return known->identifier;
    const auto isGone = [](const Garment& known) { return !known.node.valid() && !exist(known.meshes); };
    _garments.erase(std::remove_if(_garments.begin(), _garments.end(), isGone), _garments.end());
    _garments.push_back({&garment, {meshes.begin(), meshes.end()}, randomIdentifier()});
    return _garments.back().identifier;
}

std::string Wardrobe::identifierOf(const osg::Node& garment, const Meshes& meshes) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const Garment* known = find(garment, meshes);
    return known ? known->identifier : "";
}

std::string Wardrobe::identifierOf(const osg::Object& mesh)
{
    std::string identifier;
    return mesh.getUserValue(garmentKey, identifier) ? identifier : "";
}

std::shared_ptr<const AnimationSet> Wardrobe::withoutUnused(const std::shared_ptr<const AnimationSet>& set,
                                                            const osg::Group& meshes)
{
    if (set->garments().empty()) return set;
    std::size_t needed = 0;
    forEachMesh(meshes, [&](const SkinnedGeometry& mesh)
                { forEachEntry(mesh, [&](std::size_t entry) { needed = std::max(needed, entry + 1); }); });
    std::vector<Skin> garments;
    for (std::size_t end = set->levels().back(); end < needed && garments.size() < set->garments().size();)
    {
        garments.push_back(set->garments()[garments.size()]);
        end += garments.back().joints.size();
    }
    const Result<std::shared_ptr<const AnimationSet>> fewer = set->withGarments(std::move(garments));
    return fewer ? fewer.value() : set;
}

std::shared_ptr<const ClipBoxes> Wardrobe::boxes(const Meshes& meshes, const std::shared_ptr<const AnimationSet>& set)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (auto known = _outfits.begin(); known != _outfits.end();)
    {
        const bool exists = !known->set.expired() && exist(known->meshes);
        if (exists && known->set.lock() == set && areSame(known->meshes, meshes)) return known->boxes;
        known = exists ? std::next(known) : _outfits.erase(known);
    }
    const auto boxes = std::make_shared<const ClipBoxes>(*set, mixBoxesOf(meshes, *set));
    _outfits.push_back({{meshes.begin(), meshes.end()}, set, boxes});
    return boxes;
}

} // namespace osgGpuAnimation
