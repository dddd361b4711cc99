// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimationSet.h"

#include "serializers/StoredClips.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <map>
#include <mutex>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::int32_t version = 2; ///< 1: no compact clips

void writeMatrix(ValueWriter& out, const AffineMatrix& matrix)
{
    for (const glm::vec4& row : matrix.rows)
        out.floats(&row.x, 4);
}

AffineMatrix readMatrix(ValueReader& in)
{
    AffineMatrix matrix;
    for (glm::vec4& row : matrix.rows)
        in.floats(&row.x, 4);
    return matrix;
}

void writeSkeleton(ValueWriter& out, const Skeleton& skeleton)
{
    out.open("Joints", skeleton.jointCount());
    for (const Joint& joint : skeleton.joints())
    {
        out.property("Joint").integer(joint.parent).integer(joint.sourceNode).text(joint.name);
        out.floats(&joint.rest.translation.x, 3).floats(&joint.rest.rotation.x, 4).floats(&joint.rest.scale.x, 3);
        out.endLine();
    }
    out.close();
}

/// Joints as they came: keyframes and skins go by their places.
Result<Skeleton> readSkeleton(ValueReader& in)
{
    std::vector<Joint> joints;
    const std::size_t count = in.open("Joints");
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
    {
        Joint joint;
        joint.parent = in.property("Joint").integer();
        joint.sourceNode = in.integer();
        joint.name = in.text();
        in.floats(&joint.rest.translation.x, 3);
        in.floats(&joint.rest.rotation.x, 4);
        in.floats(&joint.rest.scale.x, 3);
        joints.push_back(std::move(joint));
    }
    in.close();
    Result<Skeleton> skeleton = Skeleton::create(joints);
    for (std::size_t i = 0; skeleton && i < joints.size(); ++i)
        if (skeleton.value().jointOfInput(i) != static_cast<int>(i))
            return Error{"joint " + std::to_string(i) + " \"" + joints[i].name + "\" does not come level by level"};
    return skeleton;
}

void writeSkins(ValueWriter& out, const std::vector<Skin>& skins)
{
    out.open("Skins", skins.size());
    for (const Skin& skin : skins)
    {
        out.property("Skin").text(skin.name).endLine();
        out.open("InverseBinds", skin.joints.size());
        for (std::size_t place = 0; place < skin.joints.size(); ++place)
        {
            out.property("Joint").integer(skin.joints[place]);
            writeMatrix(out, skin.inverseBinds[place]);
            out.endLine();
        }
        out.close();
    }
    out.close();
}

std::vector<Skin> readSkins(ValueReader& in)
{
    std::vector<Skin> skins;
    const std::size_t count = in.open("Skins");
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
    {
        Skin skin;
        skin.name = in.property("Skin").text();
        const std::size_t joints = in.open("InverseBinds");
        for (std::size_t place = 0; place < joints && in.isGood(); ++place)
        {
            skin.joints.push_back(in.property("Joint").integer());
            skin.inverseBinds.push_back(readMatrix(in));
        }
        in.close();
        skins.push_back(std::move(skin));
    }
    in.close();
    return skins;
}

void writeRigidJoints(ValueWriter& out, const std::vector<int>& joints)
{
    out.property("RigidJoints").count(joints.size());
    for (const int joint : joints)
        out.integer(joint);
    out.endLine();
}

std::vector<int> readRigidJoints(ValueReader& in)
{
    std::vector<int> joints;
    const std::size_t count = in.property("RigidJoints").count();
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
        joints.push_back(in.integer());
    return joints;
}

void writeMorphs(ValueWriter& out, const std::vector<MorphWeights>& morphs)
{
    out.open("Morphs", morphs.size());
    for (const MorphWeights& morph : morphs)
    {
        out.property("Morph").integer(morph.sourceNode).text(morph.name).count(morph.defaults.size());
        out.floats(morph.defaults.data(), morph.defaults.size()).endLine();
    }
    out.close();
}

std::vector<MorphWeights> readMorphs(ValueReader& in)
{
    std::vector<MorphWeights> morphs;
    const std::size_t count = in.open("Morphs");
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
    {
        MorphWeights morph;
        morph.sourceNode = in.property("Morph").integer();
        morph.name = in.text();
        const std::size_t weights = in.count();
        in.floats(morph.defaults, weights);
        morphs.push_back(std::move(morph));
    }
    in.close();
    return morphs;
}

} // namespace

osg::ref_ptr<StoredAnimationSet> StoredAnimationSet::of(const std::shared_ptr<const AnimationSet>& set)
{
    static std::mutex mutex;
    static std::map<const AnimationSet*, osg::ref_ptr<StoredAnimationSet>> known;
    const std::lock_guard<std::mutex> lock(mutex);
    for (auto entry = known.begin(); entry != known.end();)
        entry = entry->second->_written.expired() ? known.erase(entry) : std::next(entry);
    osg::ref_ptr<StoredAnimationSet>& stored = known[set.get()];
    if (!stored) stored = new StoredAnimationSet;
    stored->_written = set;
    return stored;
}

void StoredAnimationSet::write(ValueWriter& out) const
{
    const std::shared_ptr<const AnimationSet> written = set();
    out.integer(version).endLine();
    writeSkeleton(out, written->skeleton());
    writeSkins(out, written->skins());
    writeRigidJoints(out, written->rigidJoints());
    writeMorphs(out, written->morphs());
    writeClips(out, written->clips());
}

void StoredAnimationSet::read(ValueReader& in)
{
    const std::int32_t found = in.integer("the version of an animation set", 1, version);
    Result<Skeleton> skeleton = readSkeleton(in);
    if (!skeleton) return in.fail(skeleton.error().message);
    std::vector<Skin> skins = readSkins(in);
    std::vector<int> rigidJoints = readRigidJoints(in);
    std::vector<MorphWeights> morphs = readMorphs(in);
    std::vector<Clip> clips = readClips(in, skeleton.value(), morphs, found > 1);
    if (!in.isGood()) return;
    Result<std::shared_ptr<const AnimationSet>> made = AnimationSet::create(
        {std::move(skeleton).value(), std::move(skins), std::move(rigidJoints), std::move(morphs), std::move(clips)});
    if (!made) return in.fail(made.error().message);
    _read = made.value();
}

void writeSet(ValueWriter& out, const std::shared_ptr<const AnimationSet>& set)
{
    out.begin();
    out.object(StoredAnimationSet::of(set));
    out.close();
}

std::shared_ptr<const AnimationSet> readSet(ValueReader& in)
{
    in.begin();
    const osg::ref_ptr<StoredAnimationSet> stored = in.objectOf<StoredAnimationSet>();
    in.close();
    const std::shared_ptr<const AnimationSet> set = stored ? stored->set() : nullptr;
    if (!set) in.fail("a character without an animation set");
    return set;
}

} // namespace osgGpuAnimation::serializers
