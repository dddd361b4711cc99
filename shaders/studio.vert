// SPDX-License-Identifier: MIT
// A rectangle that fills the picture, and for each pixel the ray from the eye in the ground's space (see studio.frag).
uniform vec3 rayStarts[3];     // in the middle of the picture, and what a unit to the right and a unit up adds
uniform vec3 rayDirections[3]; // the same

in vec2 corner; // [-1, 1]

out vec3 rayStart;
out vec3 rayDirection;
out float height; // in the picture, [0, 1]

void main()
{
    rayStart = rayStarts[0] + corner.x * rayStarts[1] + corner.y * rayStarts[2];
    rayDirection = rayDirections[0] + corner.x * rayDirections[1] + corner.y * rayDirections[2];
    height = 0.5 + 0.5 * corner.y;
    gl_Position = vec4(corner, 0.0, 1.0);
}
