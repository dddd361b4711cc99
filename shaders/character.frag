// SPDX-License-Identifier: MIT
// Base colour times light 0 of OSG, per fragment. In a core profile, which has no lights: a headlight.

uniform sampler2D baseColorTexture;
uniform float alphaCutoff;
uniform bool unlit;
uniform bool flatNormals; // the mesh has none: each face its own, of the pose

in vec3 viewPosition;
in vec3 viewNormal;
in vec4 vertexColor;
in vec2 textureCoordinate;

out vec4 fragmentColor;

vec3 litColor(vec3 baseColor)
{
    vec3 facing = gl_FrontFacing ? viewNormal : -viewNormal;
    if (flatNormals) facing = cross(dFdx(viewPosition), dFdy(viewPosition));
    vec3 normal = normalize(facing);
#ifdef GL_ARB_compatibility
    vec4 position = gl_LightSource[0].position;
    vec3 toLight = normalize(position.w == 0.0 ? position.xyz : position.xyz - viewPosition);
    vec3 halfway = normalize(toLight - normalize(viewPosition));
    float diffuse = max(dot(normal, toLight), 0.0);
    float specular = diffuse > 0.0 ? pow(max(dot(normal, halfway), 0.0), max(gl_FrontMaterial.shininess, 1.0)) : 0.0;
    vec3 ambient = gl_LightModel.ambient.rgb + gl_LightSource[0].ambient.rgb;
    return gl_FrontMaterial.emission.rgb + baseColor * (ambient + diffuse * gl_LightSource[0].diffuse.rgb) +
           specular * gl_FrontMaterial.specular.rgb * gl_LightSource[0].specular.rgb;
#else
    return baseColor * (0.2 + 0.8 * max(dot(normal, normalize(-viewPosition)), 0.0));
#endif
}

void main()
{
    vec4 baseColor = vertexColor * texture(baseColorTexture, textureCoordinate);
#ifdef GL_ARB_compatibility
    baseColor *= gl_FrontMaterial.diffuse;
#endif
    if (baseColor.a < alphaCutoff) discard;
    fragmentColor = vec4(unlit ? baseColor.rgb : litColor(baseColor.rgb), baseColor.a);
}
