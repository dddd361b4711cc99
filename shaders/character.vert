// SPDX-License-Identifier: MIT
// Draws a SkinnedGeometry: skins, then what the fixed pipeline does.

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
vec4 osgGpuAnimationTint();
void osgGpuAnimationMorphColor(inout vec4 color);
void osgGpuAnimationMorphTextureCoordinate(inout vec2 coordinate);

out vec3 viewPosition;
out vec3 viewNormal;
out vec4 vertexColor;
out vec2 textureCoordinate;

void main()
{
    vec4 vertex = gl_Vertex;
    vec3 normal = gl_Normal;
    osgGpuAnimationSkin(vertex, normal);
    viewPosition = (gl_ModelViewMatrix * vertex).xyz;
    viewNormal = gl_NormalMatrix * normal;
    vertexColor = gl_Color;
    osgGpuAnimationMorphColor(vertexColor);
    vertexColor *= osgGpuAnimationTint();
    textureCoordinate = gl_MultiTexCoord0.xy;
    osgGpuAnimationMorphTextureCoordinate(textureCoordinate);
    gl_Position = gl_ModelViewProjectionMatrix * vertex;
}
