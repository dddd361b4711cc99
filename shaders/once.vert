// SPDX-License-Identifier: MIT
// Skins a mesh once a frame: what skin.glsl makes of each vertex, for transform feedback. ONCE_NORMALS: 1 or 0.

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);

out vec4 skinnedPosition; // in the character's own space
#if ONCE_NORMALS
out vec4 skinnedNormal; // not made unit
#endif

void main()
{
    vec4 vertex = gl_Vertex;
    vec3 normal = gl_Normal;
    osgGpuAnimationSkin(vertex, normal);
    skinnedPosition = vertex;
#if ONCE_NORMALS
    skinnedNormal = vec4(normal, 0.0);
#endif
    gl_Position = vertex;
}
