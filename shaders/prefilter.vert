// SPDX-License-Identifier: MIT
// A triangle that covers the viewport, see prefilter.frag. It has no vertex attributes.

out vec2 place; // on the face, -1 to 1

void main()
{
    place = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(place, 0.0, 1.0);
}
