// Private to the folder: the programs that draw strokes; see strokes.h. Without a graphics card
// they run on the processor, once for every corner and pixel of every stroke: what is the same for
// a whole stroke is worked out per corner, and limbs, flat and thin strokes have a program each.
#pragma once

namespace marey::render {

// In both: vertexMC says which corner this is (x: at the end, y: on the left), strokeFrom and
// strokeTo are places and radii, strokeInk is colour, opacity and kind; see StrokeBatch::set.
// strokeEye is the eye (w = 1) or the direction towards it (w = 0, no perspective); strokePixel
// the size of a pixel in metres, at a distance of one metre with perspective.

inline constexpr const char* limbVertexShader = R"glsl(
//VTK::System::Dec
in vec4 vertexMC;
in vec4 strokeFrom;
in vec4 strokeTo;
in vec2 strokeInk;
uniform mat4 MCDCMatrix;
//VTK::CustomUniforms::Dec
out vec2 place;
flat out vec4 form;
flat out vec4 ink;
flat out vec4 lightAlong;
flat out vec4 lightAcross;
flat out vec4 lightFacing;
flat out vec4 lightShaft;
flat out float depthPerM;

// What the sky, the main light, the fill light and the gloss see of a direction.
vec4 lit(vec3 direction)
{
  return vec4(direction.y, dot(direction, strokeKey), dot(direction, strokeFill),
              dot(direction, strokeGloss));
}

void main()
{
  vec3 a = strokeFrom.xyz;
  vec3 b = strokeTo.xyz;
  float opacity = mod(strokeInk.y, 256.0);
  ink = vec4(mod(strokeInk.x, 256.0), mod(floor(strokeInk.x / 256.0), 256.0),
             floor(strokeInk.x / 65536.0), opacity) / 255.0;
  vec3 facing = strokeEye.xyz - strokeEye.w * 0.5 * (a + b);
  float away = length(facing);
  facing /= away;
  float pixel = strokePixel * mix(1.0, away, strokeEye.w);
  float ra = max(strokeFrom.w, 0.6 * pixel);
  float rb = max(strokeTo.w, 0.6 * pixel);
  vec3 axis = b - a;
  float towards = dot(axis, facing);
  vec3 along = axis - facing * towards;
  float reach = length(along);
  along = reach > 1.0e-5 ? along / reach : normalize(cross(vec3(0.31, 0.59, 0.74), facing));
  vec3 across = cross(facing, along);
  // Light falls on a limb that points at the viewer as on a tilted tube.
  vec3 shaft = reach > 1.0e-3 ? normalize(facing * dot(axis, axis) - axis * towards) : facing;
  lightAlong = lit(along);
  lightAcross = lit(across);
  lightFacing = lit(facing);
  lightShaft = lit(shaft);
  float past = mix(-(ra + pixel), rb + pixel, vertexMC.x);
  place = vec2(past + vertexMC.x * reach, (vertexMC.y * 2.0 - 1.0) * (max(ra, rb) + pixel));
  form = vec4(reach, ra, (rb - ra) / max(reach, 1.0e-5), pixel);
  vec3 p = mix(a, b, vertexMC.x) + along * past + across * place.y;
  gl_Position = opacity > 0.0 ? MCDCMatrix * vec4(p, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  // Depth is strokeDepth / distance with perspective, and proportional to it without.
  depthPerM = strokeDepth * (strokeEye.w > 0.5 ? 1.0 / (away * away) : 1.0);
}
)glsl";

// strokePass: 0 draws what is solid, 1 lays down the depth of what is seen through, 2 draws that.
// 3 and 4 do the same for solid limbs that show through what lies over them, nearer than all else:
// their depths are a sixteenth. What lies before them keeps 0.45 of its opacity.
inline constexpr const char* limbFragmentShader = R"glsl(
//VTK::System::Dec
//VTK::Output::Dec
//VTK::CustomUniforms::Dec
in vec2 place;
flat in vec4 form;
flat in vec4 ink;
flat in vec4 lightAlong;
flat in vec4 lightAcross;
flat in vec4 lightFacing;
flat in vec4 lightShaft;
flat in float depthPerM;

void main()
{
  float reached = clamp(place.x, 0.0, form.x);
  float radius = form.y + form.z * reached;
  vec2 off = vec2(place.x - reached, place.y);
  float far2 = dot(off, off);
  float cover = clamp(0.5 + (radius - sqrt(far2)) / form.w, 0.0, 1.0);
  bool depthOnly = strokePass == 1 || strokePass == 3;
  if (cover < (depthOnly ? 0.9 : 0.01)) {
    discard;
  }
  off /= radius;
  float front = sqrt(max(0.0, 1.0 - far2 / (radius * radius)));
  // What is laid down lies a hair behind what is drawn, so that rounding cannot hide it. The soft
  // edge of a solid limb lies further back: it must not keep out the limb that it fades into.
  float bulge = strokePass == 0 && cover < 0.99 ? -2.0 : front;
  gl_FragDepth = gl_FragCoord.z - depthPerM * bulge * radius;
  if (strokePass > 2) {
    gl_FragDepth *= 0.0625;
  }
  if (depthOnly) {
    gl_FragDepth += 4.0e-7;
  }
  bool onShaft = off.x == 0.0;
  vec4 light = off.x * lightAlong + off.y * lightAcross +
               front * (onShaft ? lightShaft : lightFacing);
  vec3 falls = max(light.yzw, 0.0);
  float gloss = falls.z * falls.z;
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;
  float bright = 0.52 + 0.09 * light.x + 0.46 * falls.x + 0.13 * falls.y;
  vec3 colour = ink.rgb * (bright * (0.8 + 0.2 * front)) + vec3(0.13 * gloss);
  gl_FragData[0] = vec4(colour, depthOnly ? 0.0 : cover * ink.a * (strokePass == 4 ? 0.55 : 1.0));
}
)glsl";

inline constexpr const char* flatVertexShader = R"glsl(
//VTK::System::Dec
in vec4 vertexMC;
in vec4 strokeFrom;
in vec4 strokeTo;
in vec2 strokeInk;
uniform mat4 MCDCMatrix;
//VTK::CustomUniforms::Dec
out vec2 place;
flat out vec4 form;
flat out vec4 ink;
flat out float kind;

void main()
{
  vec3 a = strokeFrom.xyz;
  vec3 b = strokeTo.xyz;
  kind = floor(strokeInk.y / 256.0);
  float opacity = mod(strokeInk.y, 256.0);
  ink = vec4(mod(strokeInk.x, 256.0), mod(floor(strokeInk.x / 256.0), 256.0),
             floor(strokeInk.x / 65536.0), opacity) / 255.0;
  vec3 facing = strokeEye.xyz - strokeEye.w * 0.5 * (a + b);
  float away = length(facing);
  facing /= away;
  float pixel = strokePixel * mix(1.0, away, strokeEye.w);
  bool onFloor = kind < 3.5;
  bool ring = kind > 2.5 && onFloor;
  float unit = onFloor ? 1.0 : pixel;
  float ra = max(strokeFrom.w * unit, 0.6 * pixel);
  float rb = max(strokeTo.w * unit, 0.6 * pixel);
  float outer = ring ? ra + rb : max(ra, rb);
  float pad = pixel;
  if (onFloor) {
    pad = pixel / max(0.12, abs(facing.y));
    facing = vec3(0.0, 1.0, 0.0);
  }
  vec3 along = b - a;
  along -= facing * dot(along, facing);
  float reach = length(along);
  along = reach > 1.0e-5 ? along / reach : normalize(cross(vec3(0.31, 0.59, 0.74), facing));
  float past = (vertexMC.x * 2.0 - 1.0) * (outer + pad);
  place = vec2(past + vertexMC.x * reach, (vertexMC.y * 2.0 - 1.0) * (outer + pad));
  form = vec4(reach, ra, ring ? rb : (rb - ra) / max(reach, 1.0e-5), pixel);
  vec3 p = mix(a, b, vertexMC.x) + along * past + cross(facing, along) * place.y;
  gl_Position = opacity > 0.0 ? MCDCMatrix * vec4(p, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
)glsl";

inline constexpr const char* flatFragmentShader = R"glsl(
//VTK::System::Dec
//VTK::Output::Dec
in vec2 place;
flat in vec4 form;
flat in vec4 ink;
flat in float kind;

void main()
{
  float reached = clamp(place.x, 0.0, form.x);
  float far = length(vec2(place.x - reached, place.y));
  float outside = far - form.y - form.z * reached;
  float soft = form.w;
  if (kind < 3.5) {
    if (kind > 2.5) {
      outside = abs(far - form.y) - form.z;
    }
    soft = fwidth(outside);
  }
  float cover = clamp(0.5 - outside / soft, 0.0, 1.0);
  bool link = (kind > 1.5 && kind < 2.5) || kind > 4.5;
  if (cover < 0.01 || (link && reached != place.x)) {
    discard;
  }
  gl_FragData[0] = vec4(ink.rgb, cover * ink.a);
}
)glsl";

// vertexMC.x says which end this is; strokeWindow is the viewport in the window: left, low, width,
// height in pixels. What is before the near plane is cut here, as it has no place in the window.
inline constexpr const char* thinVertexShader = R"glsl(
//VTK::System::Dec
in vec4 vertexMC;
in vec4 strokeFrom;
in vec4 strokeTo;
in vec2 strokeInk;
uniform mat4 MCDCMatrix;
//VTK::CustomUniforms::Dec
flat out vec4 line;
flat out vec2 form;
flat out vec4 ink;

void main()
{
  float opacity = mod(strokeInk.y, 256.0);
  ink = vec4(mod(strokeInk.x, 256.0), mod(floor(strokeInk.x / 256.0), 256.0),
             floor(strokeInk.x / 65536.0), opacity) / 255.0;
  vec4 a = MCDCMatrix * vec4(strokeFrom.xyz, 1.0);
  vec4 b = MCDCMatrix * vec4(strokeTo.xyz, 1.0);
  float seenA = a.z + a.w;
  float seenB = b.z + b.w;
  if (opacity <= 0.0 || max(seenA, seenB) <= 0.0) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  if (seenA < 0.0) {
    a = mix(a, b, seenA / (seenA - seenB));
  }
  if (seenB < 0.0) {
    b = mix(b, a, seenB / (seenB - seenA));
  }
  vec2 from = (a.xy / a.w * 0.5 + 0.5) * strokeWindow.zw + strokeWindow.xy;
  vec2 along = (b.xy / b.w * 0.5 + 0.5) * strokeWindow.zw + strokeWindow.xy - from;
  float reach = length(along);
  along = reach > 1.0e-3 ? along / reach : vec2(1.0, 0.0);
  line = vec4(from, along);
  form = vec2(reach, strokeFrom.w + 0.5);
  // The ends of wide lines are cut along an axis of the window.
  vec2 past = along * form.y / max(abs(along.x), abs(along.y)) * (vertexMC.x * 2.0 - 1.0);
  gl_Position = vertexMC.x > 0.5 ? b : a;
  gl_Position.xy += past * 2.0 / strokeWindow.zw * gl_Position.w;
}
)glsl";

inline constexpr const char* thinFragmentShader = R"glsl(
//VTK::System::Dec
//VTK::Output::Dec
flat in vec4 line;
flat in vec2 form;
flat in vec4 ink;

void main()
{
  vec2 place = gl_FragCoord.xy - line.xy;
  float cover = form.y - length(place - line.zw * clamp(dot(place, line.zw), 0.0, form.x));
  if (cover < 0.01) {
    discard;
  }
  gl_FragData[0] = vec4(ink.rgb, min(cover, 1.0) * ink.a);
}
)glsl";

}  // namespace marey::render
