// SPDX-License-Identifier: MIT
// libFuzzer target: scenes of OSG and of the kit, made from the input, through the export and back through the import.
// Whatever is written must be read without an error, and without a warning but those about clips and meshes far out.
#include "gltf/Export.h"
#include "gltf/Import.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <fuzzer/FuzzedDataProvider.h>
#include <osg/AlphaFunc>
#include <osg/CameraView>
#include <osg/LightSource>
#include <osg/LOD>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/Switch>
#include <osg/Texture2D>
#include <osg/ValueObject>

#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

using namespace osgGpuAnimation;
using namespace osgGpuAnimation::gltf;

namespace
{

constexpr std::size_t maxNodes = 40;

/// Makes a scene from bytes.
class SceneMaker
{
public:
    SceneMaker(const std::uint8_t* data, std::size_t size) : _bytes(data, size)
    {
        fill(*_top, nullptr, 0);
        // One group below itself: OSG counts update callbacks without end if more are added.
        if (chance(8)) anyGroup().addChild(&anyGroup());
    }
    /// Takes the groups apart: they may be below themselves.
    ~SceneMaker()
    {
        for (const osg::ref_ptr<osg::Group>& group : _groups)
            group->removeChildren(0, group->getNumChildren());
    }
    const osg::Node& scene() const { return *_top; }

private:
    bool chance(int oneOf) { return below(oneOf) == 0; }
    int below(int end) { return _bytes.ConsumeIntegralInRange<int>(0, end - 1); }
    std::string name()
    {
        return chance(3) ? _bytes.ConsumeRandomLengthString(6) : std::string(1, char('a' + below(3)));
    }

    template <typename List>
    auto& any(List& list)
    {
        return list[static_cast<std::size_t>(below(static_cast<int>(std::size(list))))];
    }
    osg::Group& anyGroup() { return *any(_groups); }

    double number()
    {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        static const double odd[] = {
            0.0,  1.0,   -1.0,     0.5,       2.0,         180.0, 1e-30, -1e-300, 1e20, 3e38, -3.4028234663852886e38,
            1e39, 1e300, infinity, -infinity, std::nan("")};
        return chance(4) ? any(odd) : below(2001) / 1000.0 - 1.0;
    }
    float real() { return static_cast<float>(number()); }
    osg::Vec3 vec3() { return {real(), real(), real()}; }
    osg::Vec4 vec4() { return {real(), real(), real(), real()}; }

    osg::Matrixd matrix()
    {
        osg::Matrixd made = osg::Matrixd::translate(number(), number(), number());
        if (chance(2)) made.preMult(osg::Matrixd::scale(number(), number(), number()));
        if (chance(4)) made.preMult(osg::Matrixd::rotate(number(), osg::Vec3d(1, 2, 3)));
        if (chance(4)) made.preMult(osg::Matrixd::scale(1.0, number(), 2.0));
        if (chance(16)) made(below(4), below(4)) = number();
        return made;
    }

    AffineMatrix affine()
    {
        AffineMatrix made;
        for (glm::vec4& row : made.rows)
            if (chance(3)) row = glm::vec4(real(), real(), real(), real());
        return made;
    }

    template <typename Array>
    osg::Array* filled(int count)
    {
        auto* const made = new Array;
        for (int i = 0; i < count; ++i)
        {
            typename Array::ElementDataType element;
            for (int component = 0; component < Array::ElementDataType::num_components; ++component)
                element[component] = static_cast<typename Array::ElementDataType::value_type>(
                    std::is_floating_point_v<typename Array::ElementDataType::value_type> ? number() : below(256));
            made->push_back(element);
        }
        return made;
    }

    /// Null now and then.
    osg::ref_ptr<osg::Array> array(int count, bool isUsual)
    {
        osg::ref_ptr<osg::Array> made;
        if (chance(8)) count = below(10);
        const int kind = isUsual && !chance(8) ? 0 : below(8);
        if (kind == 0) made = filled<osg::Vec3Array>(count);
        if (kind == 1) made = filled<osg::Vec2Array>(count);
        if (kind == 2) made = filled<osg::Vec4Array>(count);
        if (kind == 3) made = filled<osg::Vec3dArray>(count);
        if (kind == 4) made = filled<osg::Vec4ubArray>(count);
        if (kind == 5) made = new osg::FloatArray(static_cast<unsigned int>(count));
        if (kind == 6) made = filled<osg::Vec4dArray>(count);
        if (!made) return nullptr;
        made->setBinding(chance(6) ? static_cast<osg::Array::Binding>(below(5)) : osg::Array::BIND_PER_VERTEX);
        return made;
    }

    int anyCount(int vertices)
    {
        if (!chance(4)) return below(vertices + 1);
        return chance(2) ? 2'000'000'000 : _bytes.ConsumeIntegral<int>();
    }

    template <typename Elements>
    osg::PrimitiveSet* elements(GLenum mode, int vertices)
    {
        auto* const made = new Elements(mode);
        for (int i = below(12); i > 0; --i)
            made->push_back(static_cast<typename Elements::value_type>(chance(24) ? -below(9) : below(vertices + 1)));
        return made;
    }

    osg::PrimitiveSet* primitives(int vertices)
    {
        const auto mode = static_cast<GLenum>(chance(8) ? below(16) : chance(2) ? GL_TRIANGLES : below(10));
        const int kind = below(7), first = chance(4) ? anyCount(vertices) : 0;
        if (kind < 2) return new osg::DrawArrays(mode, first, anyCount(vertices));
        if (kind == 2) return elements<osg::DrawElementsUByte>(mode, vertices);
        if (kind == 3) return elements<osg::DrawElementsUShort>(mode, vertices);
        if (kind == 4) return elements<osg::DrawElementsUInt>(mode, vertices);
        if (kind == 5) return nullptr;
        auto* const made = new osg::DrawArrayLengths(mode, first);
        for (int i = below(4); i > 0; --i)
            made->push_back(anyCount(vertices));
        return made;
    }

    osg::ref_ptr<osg::Texture2D> texture()
    {
        if (!_textures.empty() && chance(2)) return any(_textures);
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        static const GLenum formats[] = {GL_RGB, GL_RGBA, GL_LUMINANCE, GL_BGRA, GL_ALPHA, GL_RED};
        static const GLenum types[] = {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_FLOAT};
        if (!chance(8)) image->allocateImage(1 + below(4), 1 + below(4), 1, any(formats), any(types));
        if (image->data())
            std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(below(256)));
        image->setName(name());
        const osg::ref_ptr<osg::Texture2D> made = new osg::Texture2D(chance(16) ? nullptr : image.get());
        static const osg::Texture::WrapMode wraps[] = {osg::Texture::CLAMP, osg::Texture::REPEAT, osg::Texture::MIRROR,
                                                       osg::Texture::CLAMP_TO_BORDER};
        made->setWrap(osg::Texture::WRAP_S, any(wraps));
        _textures.push_back(made);
        return made;
    }

    void setState(osg::Node& node)
    {
        if (!chance(2)) return;
        osg::StateSet& state = *node.getOrCreateStateSet();
        state.setName(name());
        if (chance(2))
        {
            PbrMaterial material;
            material.baseColor = vec4();
            for (osg::Vec3 PbrMaterial::*color :
                 {&PbrMaterial::emissive, &PbrMaterial::specularColor, &PbrMaterial::sheenColor})
                material.*color = vec3();
            for (float PbrMaterial::*factor :
                 {&PbrMaterial::metallic, &PbrMaterial::roughness, &PbrMaterial::normalScale,
                  &PbrMaterial::occlusionStrength, &PbrMaterial::emissiveStrength, &PbrMaterial::specular,
                  &PbrMaterial::clearcoat, &PbrMaterial::clearcoatRoughness, &PbrMaterial::clearcoatNormalScale,
                  &PbrMaterial::sheenRoughness, &PbrMaterial::transmission})
                material.*factor = real();
            for (PbrMaterial::Map PbrMaterial::*map :
                 {&PbrMaterial::baseColorMap, &PbrMaterial::normalMap, &PbrMaterial::occlusionMap,
                  &PbrMaterial::emissiveMap, &PbrMaterial::metallicRoughnessMap, &PbrMaterial::clearcoatNormalMap,
                  &PbrMaterial::sheenColorMap, &PbrMaterial::specularMap, &PbrMaterial::transmissionMap})
                if (chance(3)) material.*map = {texture(), below(3)};
            material.isSpecularGlossiness = chance(4);
            material.isBlended = chance(4);
            applyPbrMaterial(state, material);
        }
        else
        {
            const osg::ref_ptr<osg::Material> material = new osg::Material;
            material->setDiffuse(osg::Material::FRONT_AND_BACK, vec4());
            material->setEmission(osg::Material::FRONT_AND_BACK, vec4());
            material->setSpecular(osg::Material::FRONT_AND_BACK, vec4());
            material->setShininess(osg::Material::FRONT_AND_BACK, real());
            state.setAttribute(material);
            if (chance(2)) state.setTextureAttributeAndModes(0, texture());
        }
        if (chance(6)) state.addUniform(new osg::Uniform("alphaCutoff", real()));
        if (chance(6)) state.addUniform(new osg::Uniform("unlit", true));
        if (chance(6)) state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, real()));
        if (chance(6)) state.setMode(GL_BLEND, osg::StateAttribute::ON);
        if (!chance(6)) return;
        const osg::ref_ptr<osg::Uniform> rows = new osg::Uniform(osg::Uniform::FLOAT_VEC3, "textureTransforms", 6);
        for (unsigned int row = 0; row < 6; ++row)
            rows->setElement(row, vec3());
        state.addUniform(rows);
    }

    void fillGeometry(osg::Geometry& geometry)
    {
        const int count = 1 + below(6);
        geometry.setName(name());
        geometry.setVertexArray(array(count, true));
        if (chance(2)) geometry.setNormalArray(array(count, true));
        if (chance(3)) geometry.setColorArray(array(count, false));
        if (chance(2)) geometry.setTexCoordArray(0, array(count, false));
        if (chance(4)) geometry.setVertexAttribArray(4, array(count, false));
        if (chance(4)) geometry.setVertexAttribArray(9, array(count, false));
        for (int i = 1 + below(3); i > 0; --i)
            geometry.getPrimitiveSetList().push_back(primitives(count));
        setState(geometry);
    }

    JointTransform transform()
    {
        JointTransform made;
        if (chance(2)) made.translation = glm::vec4(real(), real(), real(), 0.0f);
        if (chance(3)) made.rotation = glm::vec4(real(), real(), real(), real());
        if (chance(3)) made.scale = glm::vec4(real(), real(), real(), 0.0f);
        return made;
    }

    Channel channel(const AnimationParts& parts)
    {
        Channel made;
        made.path = static_cast<Channel::Path>(below(parts.morphs.empty() ? 3 : 4));
        made.interpolation = static_cast<Channel::Interpolation>(below(3));
        const bool isWeights = made.path == Channel::Path::Weights;
        made.target = below(isWeights ? int(parts.morphs.size()) : int(parts.skeleton.jointCount()));
        std::size_t numbers = made.path == Channel::Path::Rotation ? 4 : 3;
        if (isWeights) numbers = parts.morphs[static_cast<std::size_t>(made.target)].defaults.size();
        if (made.interpolation == Channel::Interpolation::CubicSpline) numbers *= 3;
        double time = std::abs(number());
        for (int key = 1 + below(4); key > 0; --key)
        {
            made.times.push_back(time);
            time += chance(4) ? std::abs(number()) : chance(4) ? 1e-7 : 0.25;
            for (std::size_t i = 0; i < numbers; ++i)
                made.values.push_back(number());
        }
        return made;
    }

    std::shared_ptr<const AnimationSet> set()
    {
        std::vector<Joint> joints;
        for (int joint = 0; joint < 1 + below(4); ++joint)
            joints.push_back({name(), below(joint + 1) - 1, transform(), joint});
        Result<Skeleton> skeleton = Skeleton::create(std::move(joints));
        if (!skeleton) return AnimationSet::orEmpty(nullptr);
        AnimationParts parts{skeleton.value(), {}, {}, {}, {}};
        const int count = static_cast<int>(parts.skeleton.jointCount());
        for (int skin = below(3); skin > 0; --skin)
        {
            parts.skins.push_back({name(), {}, {}});
            for (int joint = 0; joint < 1 + below(count); ++joint)
            {
                parts.skins.back().joints.push_back(joint);
                parts.skins.back().inverseBinds.push_back(affine());
            }
        }
        for (int joint = 0; joint < count; ++joint)
            if (chance(2)) parts.rigidJoints.push_back(joint);
        for (int morph = below(3); morph > 0; --morph)
        {
            MorphWeights weights;
            weights.name = name();
            for (int target = 1 + below(3); target > 0; --target)
                weights.defaults.push_back(real());
            parts.morphs.push_back(weights);
        }
        for (int clip = below(3); clip > 0; --clip)
        {
            ClipBuilder builder(parts.skeleton, parts.morphs);
            for (int i = 1 + below(3); i > 0; --i)
                static_cast<void>(builder.add(channel(parts)));
            Clip made = builder.build(name());
            if (chance(3))
                if (Result<Clip> marked = made.withMarkers({{std::abs(number()), name()}})) made = marked.value();
            parts.clips.push_back(made);
        }
        const auto made = AnimationSet::create(std::move(parts));
        return made ? made.value() : AnimationSet::orEmpty(nullptr);
    }

    osg::ref_ptr<SkinnedGeometry> skinned(const AnimationSet& set)
    {
        osg::ref_ptr<SkinnedGeometry> made = new SkinnedGeometry;
        fillGeometry(*made);
        const auto count = static_cast<unsigned int>(made->getVertexCount());
        if (chance(2) || set.paletteSize() == 0)
            made->setRigidEntry(static_cast<unsigned short>(below(int(set.paletteSize()) + 1)));
        else
            for (unsigned int influences = 0; influences < static_cast<unsigned int>(1 + below(2)); ++influences)
            {
                const osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray(count);
                const osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(count);
                for (unsigned int vertex = 0; vertex < count; ++vertex)
                    for (unsigned int i = 0; i < 4; ++i)
                    {
                        (*entries)[vertex][i] = static_cast<GLushort>(below(int(set.paletteSize())));
                        (*weights)[vertex][static_cast<int>(i)] = real();
                    }
                made->setInfluences(influences, entries, weights);
            }
        if (set.morphs().empty() || !chance(2)) return made;
        const auto morph = static_cast<std::size_t>(below(int(set.morphs().size())));
        std::vector<MorphTarget> targets(static_cast<std::size_t>(1 + below(3)));
        for (MorphTarget& target : targets)
        {
            const int length = chance(8) ? below(8) : int(count);
            if (!chance(4)) target.positions = static_cast<osg::Vec3Array*>(filled<osg::Vec3Array>(length));
            if (chance(3)) target.normals = static_cast<osg::Vec3Array*>(filled<osg::Vec3Array>(length));
        }
        made->setMorphTargets(set, morph, std::move(targets));
        return made;
    }

    osg::ref_ptr<osg::Group> character()
    {
        const osg::ref_ptr<AnimatedCharacter> made = new AnimatedCharacter(set());
        made->setMatrix(matrix());
        for (int mesh = 1 + below(3); mesh > 0; --mesh)
            made->addChild(skinned(made->getAnimationSet()));
        if (!chance(4)) return made;
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*made);
        const AnimationController controller(crowd->getSharedAnimationSet());
        static_cast<void>(crowd->add(matrix(), controller));
        return crowd;
    }

    osg::ref_ptr<osg::Node> light()
    {
        const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        if (chance(8)) return source;
        const osg::ref_ptr<PunctualLight> made =
            new PunctualLight(static_cast<PunctualLight::Kind>(below(3)), static_cast<unsigned int>(below(8)));
        static_cast<void>(made->setIntensity(vec3(), real()));
        static_cast<void>(made->setCone(real(), 90.0f * real()));
        static_cast<void>(made->setRange(real()));
        if (chance(3)) made->setDiffuse(vec4());
        if (chance(3)) made->setSpotCutoff(real());
        if (chance(8)) made->setPosition(vec4());
        source->setLight(made);
        return source;
    }

    osg::ref_ptr<osg::Node> camera()
    {
        const osg::ref_ptr<osg::CameraView> made = new osg::CameraView;
        made->setPosition(osg::Vec3d(number(), number(), number()));
        if (chance(2)) made->setAttitude(osg::Quat(number(), osg::Vec3d(0, 0, 1)));
        if (!chance(4)) made->setFieldOfViewMode(osg::CameraView::VERTICAL);
        made->setFieldOfView(chance(2) ? 40.0 : number());
        if (chance(4)) made->setUserValue(orthographicHeightName, number());
        return made;
    }

    osg::ref_ptr<osg::Group> group()
    {
        const int kind = below(6);
        if (kind == 0) return new osg::Group;
        if (kind == 1) return new osg::LOD;
        if (kind > 3) return new osg::MatrixTransform(matrix());
        if (kind == 3)
        {
            const osg::ref_ptr<JointAttachment> made = new JointAttachment(name());
            static_cast<void>(made->setOffset(matrix()));
            return made;
        }
        const osg::ref_ptr<osg::Switch> made = new osg::Switch;
        made->setNewChildDefaultValue(chance(2));
        return made;
    }

    osg::ref_ptr<osg::Node> node(const AnimatedCharacter* above, int depth)
    {
        if (!_groups.empty() && chance(10)) return &anyGroup();
        const int kind = below(8);
        if (kind == 0) return light();
        if (kind == 1) return camera();
        if (kind == 2 && above) return skinned(above->getAnimationSet());
        if (kind == 3 || kind == 4)
        {
            const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
            fillGeometry(*geometry);
            return geometry;
        }
        const osg::ref_ptr<osg::Group> made = kind == 5 ? character() : group();
        fill(*made, dynamic_cast<const AnimatedCharacter*>(made.get()), depth + 1);
        return made;
    }

    void fill(osg::Group& group, const AnimatedCharacter* above, int depth)
    {
        if (depth > 0) group.setName(name());
        setState(group);
        for (int child = 1 + below(3); child > 0 && depth < 12 && _count < maxNodes && _bytes.remaining_bytes() > 0;
             --child)
        {
            ++_count;
            const osg::ref_ptr<osg::Node> made = node(above, depth);
            if (chance(12)) made->setNodeMask(0);
            group.addChild(made);
        }
        _groups.push_back(&group);
    }

    FuzzedDataProvider _bytes;
    osg::ref_ptr<osg::Group> _top = new osg::Group;
    std::vector<osg::ref_ptr<osg::Group>> _groups;
    std::vector<osg::ref_ptr<osg::Texture2D>> _textures;
    std::size_t _count = 0;
};

[[noreturn]] void fail(const std::string& message)
{
    std::cerr << "the import says of what the export wrote: " << message << std::endl;
    std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    osg::setNotifyLevel(osg::ALWAYS);
    const SceneMaker made(data, size);
    Messages messages;
    Report report(messages);
    const Result<std::string> glb = exportModel(made.scene(), report);
    if (!glb) return 0;
    ImportOptions options;
    options.noLights = true; // their data are checked all the same; a warning says that OpenGL shows seven
    const Result<ImportedModel> read = importModel(glb.value(), "", options);
    if (!read) fail(read.error().message);
    for (const std::string& warning : read.value().messages.warnings)
        if (warning.find(outOfRangeText()) == std::string::npos) fail(warning);
    return 0;
}
