// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/lod/SurfaceColor.h>

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>

#include <osg/CullFace>
#include <osg/ImageStream>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr PbrMaterial::Map PbrMaterial::*irreplaceable[] = {
    &PbrMaterial::emissiveMap,   &PbrMaterial::specularColorMap,      &PbrMaterial::specularMap,
    &PbrMaterial::clearcoatMap,  &PbrMaterial::clearcoatRoughnessMap, &PbrMaterial::clearcoatNormalMap,
    &PbrMaterial::sheenColorMap, &PbrMaterial::sheenRoughnessMap,     &PbrMaterial::transmissionMap};

/// True if the CPU can read the picture.
bool isReadable(const osg::Texture2D* texture)
{
    const osg::Image* image = texture ? texture->getImage() : nullptr;
    if (!image || !image->data() || image->isCompressed() || dynamic_cast<const osg::ImageStream*>(image)) return false;
    const GLenum format = image->getPixelFormat();
    return image->getDataType() == GL_UNSIGNED_BYTE && image->getDataVariance() != osg::Object::DYNAMIC &&
           !image->requiresUpdateCall() && image->s() > 0 && image->t() > 0 &&
           (format == GL_RGB || format == GL_RGBA || format == GL_LUMINANCE || format == GL_LUMINANCE_ALPHA);
}

bool isOpaque(const osg::StateSet& state)
{
    float cutoff = 0.0f;
    if (const osg::Uniform* uniform = state.getUniform("alphaCutoff")) uniform->get(cutoff);
    return !(cutoff > 0.0f) && state.getRenderingHint() == osg::StateSet::DEFAULT_BIN &&
           !(state.getMode(GL_BLEND) & osg::StateAttribute::ON) && state.getBinName().empty();
}

/// True if the back faces are culled, both sides are shown, and the front faces are counter-clockwise.
bool hasUsualSides(const osg::StateSet& state)
{
    const auto* cull = static_cast<const osg::CullFace*>(state.getAttribute(osg::StateAttribute::CULLFACE));
    return !state.getAttribute(osg::StateAttribute::FRONTFACE) && (!cull || cull->getMode() == osg::CullFace::BACK);
}

bool hasTextureTransform(const osg::StateSet& state)
{
    return state.getTextureAttribute(0, osg::StateAttribute::TEXMAT) ||
           state.getDefineList().count("MATERIAL_TEXTURE_TRANSFORM") > 0;
}

bool repeats(const osg::Texture2D& texture, osg::Texture::WrapParameter along)
{
    const osg::Texture::WrapMode mode = texture.getWrap(along);
    return mode == osg::Texture::REPEAT || mode == osg::Texture::MIRROR;
}

osg::Vec4 colorAt(const osg::Array& colors, std::uint32_t vertex)
{
    if (colors.getBinding() == osg::Array::BIND_OVERALL) vertex = 0;
    if (const auto* floats = dynamic_cast<const osg::Vec4Array*>(&colors)) return (*floats)[vertex];
    const osg::Vec4ub& bytes = static_cast<const osg::Vec4ubArray&>(colors)[vertex];
    return osg::Vec4(bytes.r(), bytes.g(), bytes.b(), bytes.a()) / 255.0f;
}

/// Null if the mesh has no colours; empty if they are of a kind that colorAt() does not know.
std::optional<const osg::Array*> colorsOf(const SkinnedGeometry& mesh)
{
    if (mesh.getColors() == SkinnedGeometry::Colors::White) return nullptr;
    const osg::Array* colors = mesh.getColorArray();
    if (!colors || mesh.getColors() != SkinnedGeometry::Colors::Array) return std::nullopt;
    const bool isOverall = colors->getBinding() == osg::Array::BIND_OVERALL;
    const std::size_t needed = isOverall ? 1 : mesh.getVertexCount();
    const bool isKnown = dynamic_cast<const osg::Vec4Array*>(colors) ||
                         (dynamic_cast<const osg::Vec4ubArray*>(colors) && colors->getNormalize());
    const bool isFit =
        (isOverall || colors->getBinding() == osg::Array::BIND_PER_VERTEX) && colors->getNumElements() >= needed;
    return isKnown && isFit ? std::optional(colors) : std::nullopt;
}

} // namespace

osg::Vec4 SurfaceColor::texelAt(const Map& map, const osg::Vec2& place)
{
    const osg::Image& image = *map.image;
    const auto column = [](float coordinate, bool repeats, int size)
    {
        const float share = repeats ? coordinate - std::floor(coordinate) : std::min(coordinate, 1.0f);
        const float texel = share >= 0.0f ? share * static_cast<float>(size) : 0.0f; // NaN: the first
        return static_cast<unsigned int>(std::min(static_cast<int>(texel), size - 1));
    };
    const unsigned char* texel =
        image.data(column(place.x(), map.repeatsS, image.s()), column(place.y(), map.repeatsT, image.t()));
    const unsigned int components = osg::Image::computeNumComponents(image.getPixelFormat());
    const auto component = [&](unsigned int i) { return static_cast<float>(texel[i]) / 255.0f; };
    if (components < 3) return {component(0), component(0), component(0), 1.0f};
    return {component(0), component(1), component(2), 1.0f};
}

std::optional<SurfaceColor> SurfaceColor::of(const SkinnedGeometry& mesh, const osg::StateSet* state)
{
    if (!state || !dynamic_cast<const ShaderPermutations*>(state->getAttribute(osg::StateAttribute::PROGRAM)))
        return {};
    if (!isOpaque(*state) || !hasUsualSides(*state) || hasTextureTransform(*state)) return {};
    const std::optional<const osg::Array*> colors = colorsOf(mesh);
    if (!colors) return {};
    SurfaceColor color;
    color._isTwoSided = !(state->getMode(GL_CULL_FACE) & osg::StateAttribute::ON);
    color._colors = *colors;
    const std::optional<PbrMaterial> material = pbrMaterialOf(*state);
    color._isLinear = material.has_value();
    const osg::StateAttribute* base = state->getTextureAttribute(0, osg::StateAttribute::TEXTURE);
    std::vector<std::pair<const osg::StateAttribute*, Map*>> maps;
    if (base && !isWhiteTexture(base)) maps.emplace_back(base, &color._baseColor);
    if (material)
    {
        for (const auto map : irreplaceable)
            if (((*material).*map).texture) return {};
        if (material->metallicRoughnessMap.coordinates > 0) return {};
        if (const osg::Texture2D* map = material->metallicRoughnessMap.texture)
            maps.emplace_back(map, &color._metallicRoughness);
    }
    for (const auto& [texture, map] : maps)
    {
        const auto* picture = dynamic_cast<const osg::Texture2D*>(texture);
        if (!isReadable(picture)) return {};
        *map = {picture->getImage(), repeats(*picture, osg::Texture::WRAP_S), repeats(*picture, osg::Texture::WRAP_T)};
    }
    if (maps.empty()) return color;
    color._coordinates = dynamic_cast<const osg::Vec2Array*>(mesh.getTexCoordArray(0));
    if (!color._coordinates || color._coordinates->size() < mesh.getVertexCount()) return {};
    return color;
}

SurfaceColor::Look SurfaceColor::at(const std::array<std::uint32_t, 3>& corners, const glm::vec3& shares) const
{
    osg::Vec2 place;
    osg::Vec4 ofVertices(1, 1, 1, 1);
    if (_colors) ofVertices.set(0, 0, 0, 0);
    for (int corner = 0; corner < 3; ++corner)
    {
        const std::uint32_t vertex = corners[static_cast<std::size_t>(corner)];
        if (_coordinates) place += (*_coordinates)[vertex] * shares[corner];
        if (!_colors) continue;
        const osg::Vec4 color = colorAt(*_colors, vertex);
        ofVertices += (_isLinear ? linearColor(color) : color) * shares[corner];
    }
    Look look{ofVertices, {1, 1}};
    look.color.a() = 1.0f;
    if (_baseColor.image)
    {
        const osg::Vec4 texel = texelAt(_baseColor, place);
        look.color = osg::componentMultiply(look.color, _isLinear ? linearColor(texel) : texel);
    }
    if (_metallicRoughness.image)
    {
        const osg::Vec4 texel = texelAt(_metallicRoughness, place);
        look.metallicRoughness.set(texel.b(), texel.g());
    }
    return look;
}

osg::ref_ptr<osg::StateSet> SurfaceColor::flatState(const osg::StateSet& ofMesh, int influences,
                                                    const osg::Vec2& metallicRoughness)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet(ofMesh, osg::CopyOp::SHALLOW_COPY);
    state->removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
    std::optional<PbrMaterial> material = pbrMaterialOf(ofMesh);
    const bool hasMaps = material && (material->metallicRoughnessMap.texture || material->occlusionMap.texture ||
                                      material->normalMap.texture);
    if (hasMaps)
    {
        material->metallic *= metallicRoughness.x();
        material->roughness *= metallicRoughness.y();
        for (const auto map : {&PbrMaterial::baseColorMap, &PbrMaterial::metallicRoughnessMap,
                               &PbrMaterial::occlusionMap, &PbrMaterial::normalMap})
            (*material).*map = {};
        material->hasTangents = material->hasMoreCoordinates = false;
        applyPbrMaterial(*state, *material);
    }
    state->addUniform(new osg::Uniform("flatNormals", true));
    state->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
    applyCharacterProgram(*state); // a white texture
    applySkinDefines(*state, influences, false);
    return state;
}

} // namespace osgGpuAnimation
