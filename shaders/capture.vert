// SPDX-License-Identifier: MIT
// For tools and tests: skins the vertices of a SkinnedGeometry for capture by transform feedback.

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);

out vec3 capturedPosition; // in the character's own space
out vec3 capturedNormal;   // not normalized

void main()
{
    vec4 vertex = gl_Vertex;
    vec3 normal = gl_Normal;
    osgGpuAnimationSkin(vertex, normal);
    capturedPosition = vertex.xyz;
    capturedNormal = normal;
    gl_Position = vertex;
}
