// SPDX-License-Identifier: MIT
// The constraints of a chain of joints, in single precision; the CPU twin is animation/constraints. After mix.glsl,
// local.glsl and world.glsl. All positions and axes are in the space of the parent of the chain's first joint, if no
// other space is named. Constants of the program variant: bool isLookAt (else: two-bone inverse kinematics);
// int chainLength, the joints of the chain; int midPlace, the limb's mid joint; bool hasCone, hasOffset: of look-ats;
// bool hasDirections: some target has a pole, a twist or a rotation.

// Compilers unroll a loop that runs over the whole array. In other loops they may index the array at run time: look-ats of
// three joints then take 1.7 times as long in llvmpipe.
JointTransform chain[chainLength];

// The target that the application sets, and the constraint's own numbers.
struct Goal
{
    vec3 position;
    vec3 pole; // 0: none
    float twist;
};

const float smallestSine = 1e-3;   // axes that enclose a smaller angle count as parallel
const float smallestShare = 1e-5;  // of a length: what is shorter counts as 0
const float smallestSize = 1e-36;  // a space of a smaller determinant counts as flat
const float straightLimb = 0.02;   // the sine of a bend that counts as straight

vec4 inverseOf(vec4 q)
{
    return vec4(-q.xyz, q.w);
}

vec3 turned(vec4 q, vec3 v)
{
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

vec3 direction(vec3 v, vec3 fallback)
{
    float squared = dot(v, v);
    return squared > 0.0 ? v * inversesqrt(squared) : fallback;
}

// The unit part of v that is perpendicular to a unit axis; 0 if they are parallel.
vec3 across(vec3 v, vec3 axis)
{
    vec3 part = v - axis * dot(v, axis);
    float squared = dot(part, part);
    return squared > smallestSine * smallestSine * dot(v, v) ? part / sqrt(squared) : vec3(0.0);
}

bool isNone(vec3 v)
{
    return dot(v, v) < 0.5;
}

vec3 anyAcross(vec3 axis)
{
    return normalize(cross(axis, abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
}

// The turn about an axis by an angle in (-pi, pi].
vec4 turnAbout(vec3 axis, float cosine, float sine)
{
    return normalize(cosine >= 0.0 ? vec4(axis * sine, 1.0 + cosine) : vec4(axis * (1.0 - cosine), sine));
}

// A turn from one unit vector to another: by way of half a turn about an axis perpendicular to `from`, if they are more
// than a right angle apart, so that both parts are well-conditioned.
vec4 arc(vec3 from, vec3 to, vec3 axis)
{
    bool isFar = dot(from, to) < 0.0;
    vec3 near = isFar ? -from : from;
    vec4 turn = normalize(vec4(cross(near, to), 1.0 + dot(near, to)));
    return isFar ? quaternionProduct(turn, vec4(axis, 0.0)) : turn;
}

vec4 shortestTurn(vec3 from, vec3 to, vec3 fallback)
{
    vec3 axis = cross(from, to);
    float squared = dot(axis, axis);
    return arc(from, to, squared > 1e-8 ? axis / sqrt(squared) : fallback);
}

// The turn that moves a unit vector to another and `up` to the side of `pole`.
vec4 framedTurn(vec3 from, vec3 up, vec3 to, vec3 pole)
{
    vec3 upAcross = across(up, from);
    vec3 poleAcross = across(pole, to);
    if (isNone(upAcross) || isNone(poleAcross))
        return shortestTurn(from, to, isNone(upAcross) ? anyAcross(from) : upAcross);
    vec4 turn = arc(from, to, upAcross);
    vec3 upTurned = turned(turn, upAcross);
    return quaternionProduct(turnAbout(to, dot(upTurned, poleAcross), dot(cross(upTurned, poleAcross), to)), turn);
}

// The turn, then the goal's twist about the line to the target.
vec4 twisted(vec4 turn, vec3 to, Goal goal)
{
    return hasDirections ? quaternionProduct(quaternionExponential(to * (0.5 * goal.twist)), turn) : turn;
}

vec3 pointIn(mat3x4 matrix, vec3 point)
{
    return vec4(point, 1.0) * matrix;
}

vec3 vectorIn(mat3x4 matrix, vec3 vector)
{
    return vector * mat3(matrix);
}

vec3 originOf(mat3x4 matrix)
{
    return vec3(matrix[0].w, matrix[1].w, matrix[2].w);
}

mat3x4 localOf(JointTransform t)
{
    return limitedLocal(localMatrix(t.translation, t.rotation, t.scale));
}

// The inverse of the 3x3 part; false if there is none.
bool invert(mat3x4 matrix, out mat3 inverted)
{
    vec3 a = matrix[0].xyz, b = matrix[1].xyz, c = matrix[2].xyz;
    vec3 bc = cross(b, c);
    float size = dot(a, bc);
    inverted = transpose(mat3(bc, cross(c, a), cross(a, b))) * (1.0 / size);
    return abs(size) > smallestSize;
}

// The space of joint `end`'s parent: the product of the joints before it.
mat3x4 chainMatrix(int end)
{
    mat3x4 matrix = mat3x4(1.0);
    for (int joint = 0; joint < end; ++joint)
        matrix = multiplied(matrix, localOf(chain[joint]));
    return matrix;
}

struct LookAt
{
    vec3 forward;
    vec3 up;
    vec3 offset;
    float coneCosine; // below -1: no cone
    float coneSine;
};

vec3 limitedToCone(vec3 wanted, vec3 forward, vec3 up, LookAt look)
{
    if (!hasCone || dot(wanted, forward) >= look.coneCosine) return wanted;
    vec3 side = across(wanted, forward);
    if (isNone(side)) side = across(up, forward);
    if (isNone(side)) side = anyAcross(forward);
    return forward * look.coneCosine + side * look.coneSine;
}

float shareOf(int joint); // of the turn, defined by the pass

// Turns the joints before the last by their shares. Beyond two thirds of a half turn they turn back.
void shareTurn(vec4 turn)
{
    const float pi = 3.14159265;
    vec3 halfTurn = quaternionLogarithm(turn); // in the end of at most pi / 3
    float halfAngle = length(halfTurn);
    if (halfAngle > pi / 3.0) halfTurn *= (pi - 2.0 * halfAngle) / halfAngle;
    vec4 parent = vec4(0.0, 0.0, 0.0, 1.0); // orientation of the joint's parent
    for (int joint = 0; joint < chainLength; ++joint)
    {
        if (joint + 1 == chainLength) continue;
        vec3 v = halfTurn * shareOf(joint);
        vec3 sine = v * sinc(dot(v, v));
        vec4 part = vec4(sine, sqrt(1.0 - dot(sine, sine)));
        vec4 inParent = quaternionProduct(inverseOf(parent), quaternionProduct(part, parent));
        chain[joint].rotation = quaternionProduct(inParent, chain[joint].rotation);
        parent = quaternionProduct(parent, chain[joint].rotation);
    }
}

// Turns the last joint so that the line from its offset along its forward axis meets the goal, in its parent's space.
bool aim(LookAt look, Goal goal)
{
    const int last = chainLength - 1;
    vec3 translation = chain[last].translation.xyz;
    vec3 scale = chain[last].scale.xyz;
    vec3 line = goal.position - translation;
    float away = length(line);
    if (!(away > smallestShare * (length(goal.position) + length(translation)))) return false;
    vec3 forward = direction(scale * look.forward, look.forward);
    vec3 met = forward;
    if (hasOffset)
    {
        // The forward line meets the sphere through the goal. It may miss it if the goal is nearer than the line.
        vec3 offset = scale * look.offset;
        float along = dot(offset, forward);
        met = offset + forward * (sqrt(max(away * away - dot(offset, offset) + along * along, 0.0)) - along);
        met = direction(met, forward);
    }
    vec3 from = turned(chain[last].rotation, met);
    vec3 up = turned(chain[last].rotation, direction(scale * look.up, look.up));
    vec3 to = line / away;
    vec4 turn = twisted(framedTurn(from, up, to, goal.pole), to, goal);
    chain[last].rotation = quaternionProduct(turn, chain[last].rotation);
    return true;
}

bool solveLookAt(LookAt look, Goal goal)
{
    vec3 eye = hasOffset ? look.offset : vec3(0.0);
    vec3 forward = look.forward;
    vec3 up = look.up;
    for (int joint = chainLength - 1; joint >= 0; --joint)
    {
        mat3x4 matrix = localOf(chain[joint]);
        eye = pointIn(matrix, eye);
        forward = vectorIn(matrix, forward);
        up = vectorIn(matrix, up);
    }
    forward = direction(forward, look.forward);
    up = direction(up, look.up);
    vec3 line = goal.position - eye;
    float away = length(line);
    if (!(away > smallestShare * (length(goal.position) + length(eye)))) return false;
    vec3 wanted = limitedToCone(line / away, forward, up, look);
    goal.position = eye + wanted * away;
    if (goal.pole == vec3(0.0)) goal.pole = up;
    if (chainLength > 1) shareTurn(framedTurn(forward, up, wanted, goal.pole));
    // The goal in the space of the last joint's parent.
    float size = 1.0;
    for (int joint = 0; joint < chainLength; ++joint)
    {
        if (joint + 1 == chainLength) continue;
        vec4 toJoint = inverseOf(chain[joint].rotation);
        vec3 scale = chain[joint].scale.xyz;
        size *= scale.x * scale.y * scale.z;
        goal.position = turned(toJoint, goal.position - chain[joint].translation.xyz) / scale;
        goal.pole = turned(toJoint, goal.pole) / scale;
    }
    return abs(size) > smallestSize && aim(look, goal);
}

// The distance of the end joint from the start joint: at most the length of the limb.
float reachOf(float away, float upper, float lower, float softReach)
{
    float limb = upper + lower;
    float firm = softReach * limb;
    float soft = limb - firm;
    if (away > firm && soft > smallestShare * limb)
    {
        float part = 4.0 / ((away - firm) / soft + 4.0);
        away = firm + soft * (1.0 - part * part * part * part);
    }
    return min(max(away, abs(upper - lower)), limb);
}

bool solveTwoBone(vec3 hinge, float softReach, Goal goal)
{
    mat3x4 mid = chainMatrix(midPlace + 1);
    vec3 start = chain[0].translation.xyz;
    vec3 middle = originOf(mid);
    mat3x4 end = mid;
    for (int joint = midPlace + 1; joint < chainLength; ++joint)
        end = multiplied(end, localOf(chain[joint]));
    float upper = distance(middle, start);
    float lower = distance(originOf(end), middle);
    float limb = upper + lower;
    if (!(min(upper, lower) > smallestShare * limb)) return false;
    vec3 first = (middle - start) / upper;
    vec3 second = (originOf(end) - middle) / lower;

    // The bend: about the normal of the limb's plane, on the side of the hinge.
    vec3 axis = across(vectorIn(mid, hinge), first);
    if (isNone(axis)) axis = anyAcross(first);
    vec3 normal = cross(first, second);
    float sine = length(normal);
    if (sine > straightLimb) axis = normal * ((dot(normal, axis) < 0.0 ? -1.0 : 1.0) / sine);
    vec3 line = goal.position - start;
    float away = length(line);
    float reach = reachOf(away, upper, lower, softReach);
    float along = dot(second, axis);
    float twice = 2.0 * upper * lower;
    float difference = upper - lower;
    float cosine = (reach * reach - upper * upper - lower * lower) / twice;
    float squared = (limb - reach) * (limb + reach) * (reach - difference) * (reach + difference) / (twice * twice);
    vec2 bent = normalize(vec2(cosine, sqrt(max(squared - along * along, 0.0))));
    vec2 before = normalize(vec2(dot(first, second), dot(normal, axis)));
    vec4 bend = turnAbout(axis, dot(bent, before), bent.y * before.x - bent.x * before.y);

    // The start joint turns the end to the goal and the mid joint to the side of the pole.
    vec3 chord = first * upper + turned(bend, second) * lower;
    vec3 from = length(chord) > smallestShare * limb ? normalize(chord) : first;
    vec3 to = away > smallestShare * limb ? line / away : from;
    vec4 turn = goal.pole == vec3(0.0) ? shortestTurn(from, to, axis)
                                       : framedTurn(from, cross(from, axis), to, goal.pole);
    turn = twisted(turn, to, goal);

    vec4 parent = vec4(0.0, 0.0, 0.0, 1.0); // orientation of the mid joint's parent
    for (int joint = 0; joint < midPlace; ++joint)
        parent = quaternionProduct(parent, chain[joint].rotation);
    vec4 inParent = quaternionProduct(inverseOf(parent), quaternionProduct(bend, parent));
    chain[midPlace].rotation = quaternionProduct(inParent, chain[midPlace].rotation);
    chain[0].rotation = quaternionProduct(turn, chain[0].rotation);
    return true;
}

// Gives the last joint a rotation in model space. modelToParent: the inverse of world.glsl's rows.
void orient(vec4 rotation, mat3 modelToParent)
{
    mat3x4 parent = chainMatrix(chainLength - 1);
    mat3 inverted;
    if (!invert(parent, inverted)) return;
    mat3 toParent = modelToParent * inverted;
    const vec3 x = vec3(1.0, 0.0, 0.0);
    const vec3 y = vec3(0.0, 1.0, 0.0);
    chain[chainLength - 1].rotation = framedTurn(x, y, direction(turned(rotation, x) * toParent, x),
                                                 direction(turned(rotation, y) * toParent, y));
}
