// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/scene/traversal/MeshVisits.h>

#include <osgGpuAnimation/math/detail/System.h>

#include <osg/Geode>
#include <osg/Notify>
#include <osg/UserDataContainer>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/PlaneIntersector>
#include <osgUtil/PolytopeIntersector>
#include <osgUtil/RayIntersector>

#include <algorithm>
#include <string>
#include <string_view>
#include <typeinfo>

namespace osgGpuAnimation
{

namespace
{

thread_local const MeshDrawScope* innermost = nullptr;

template <typename Intersector>
bool renameHits(osgUtil::Intersector& intersector, const osg::Drawable& posed, osg::Drawable& mesh)
{
    auto* known = dynamic_cast<Intersector*>(&intersector);
    if (!known) return false;
    // Sets of hits are not ordered by the drawable.
    for (const typename Intersector::Intersection& hit : known->getIntersections())
        if (hit.drawable == &posed) const_cast<typename Intersector::Intersection&>(hit).drawable = &mesh;
    return true;
}

void renameAllHits(osgUtil::Intersector& intersector, const osg::Drawable& posed, osg::Drawable& mesh)
{
    if (auto* group = dynamic_cast<osgUtil::IntersectorGroup*>(&intersector))
        for (const osg::ref_ptr<osgUtil::Intersector>& member : group->getIntersectors())
            renameAllHits(*member, posed, mesh);
    else
        (void)(renameHits<osgUtil::LineSegmentIntersector>(intersector, posed, mesh) ||
               renameHits<osgUtil::PolytopeIntersector>(intersector, posed, mesh) ||
               renameHits<osgUtil::RayIntersector>(intersector, posed, mesh) ||
               renameHits<osgUtil::PlaneIntersector>(intersector, posed, mesh));
}

/// True if the class lies in a library osgdb_* that writes files.
bool isOfFileWriter(const std::type_info& type)
{
    const std::string path = system::moduleOf(&type);
    std::string_view library = path;
    library.remove_prefix(path.find_last_of("/\\") + 1);
    if (library.substr(0, 6) == "mingw_") library.remove_prefix(6);
    if (library.substr(0, 6) != "osgdb_") return false;
    constexpr std::string_view others[] = {"serializers_", "gltf", "crowd", "osggpuanimation", "dot", "normals"};
    return std::none_of(std::begin(others), std::end(others),
                        [&](std::string_view other) { return library.substr(6, other.size()) == other; });
}

/// Keeps the geometry as long as the visitor exists, because some writers collect pointers and use them afterwards.
osg::Geode& keepForWriter(osg::NodeVisitor& visitor, const osg::Drawable& mesh, osg::Geometry& posed)
{
    osg::UserDataContainer& kept = *visitor.getOrCreateUserDataContainer();
    if (kept.getNumUserObjects() == 0)
        OSG_NOTICE
            << "osgGpuAnimation: the file gets the present pose without the animation; .osgb, .osgt and .osgx keep "
               "the animation"
            << std::endl;
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName(mesh.getName());
    geode->addDrawable(&posed);
    kept.addUserObject(geode);
    return *geode;
}

} // namespace

bool isFileWriter(const osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() != osg::NodeVisitor::NODE_VISITOR) return false;
    // The search takes microseconds, and a traversal asks for every mesh.
    thread_local const std::type_info* lastType = nullptr;
    thread_local bool isWriter = false;
    if (&typeid(visitor) != lastType) isWriter = isOfFileWriter(typeid(visitor));
    lastType = &typeid(visitor);
    return isWriter;
}

void visitPosed(osg::NodeVisitor& visitor, osg::Drawable& mesh, osg::Geometry& posed)
{
    if (visitor.getVisitorType() == osg::NodeVisitor::NODE_VISITOR)
        return keepForWriter(visitor, mesh, posed).accept(visitor);
    visitor.pushOntoNodePath(&mesh);
    visitor.apply(posed);
    visitor.popFromNodePath();
    auto* intersection = dynamic_cast<osgUtil::IntersectionVisitor*>(&visitor);
    if (intersection && intersection->getIntersector()) renameAllHits(*intersection->getIntersector(), posed, mesh);
}

MeshDrawScope::MeshDrawScope(const PosedMeshSource& source, Draw draw)
    : _source(source), _draw(std::move(draw)), _outer(innermost)
{
    innermost = this;
}

MeshDrawScope::~MeshDrawScope()
{
    innermost = _outer;
}

const MeshDrawScope* MeshDrawScope::current()
{
    return innermost;
}

} // namespace osgGpuAnimation
