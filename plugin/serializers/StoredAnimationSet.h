// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osg/Object>

#include <memory>

namespace osgGpuAnimation::serializers
{

class ValueReader;
class ValueWriter;

/// An AnimationSet as an object of a file: OSG writes an object once, however many others refer to it, so characters
/// that share a set share it after reading too.
class StoredAnimationSet : public osg::Object
{
public:
    StoredAnimationSet() = default;
    StoredAnimationSet(const StoredAnimationSet& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY)
        : osg::Object(other, copyop), _read(other._read), _written(other._written)
    {
    }
    META_Object(osgGpuAnimation, StoredAnimationSet)

        /// The same object for a set at any time, so that a stream knows it again. It does not keep the set.
        static osg::ref_ptr<StoredAnimationSet> of(const std::shared_ptr<const AnimationSet>& set);

    /// Null where nothing was read, or the set is gone.
    std::shared_ptr<const AnimationSet> set() const { return _read ? _read : _written.lock(); }

    void read(ValueReader& in);
    void write(ValueWriter& out) const;

protected:
    ~StoredAnimationSet() override = default;

private:
    std::shared_ptr<const AnimationSet> _read;
    std::weak_ptr<const AnimationSet> _written;
};

/// As a property of a node: writes the set, or its place in the file where it is in already.
void writeSet(ValueWriter& out, const std::shared_ptr<const AnimationSet>& set);
/// Null, and the file unreadable, where there is none.
std::shared_ptr<const AnimationSet> readSet(ValueReader& in);

} // namespace osgGpuAnimation::serializers
