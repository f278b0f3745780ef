// Shaders of the view. Everything reads its place from textures, by the number of its vertex, so
// that a new frame costs the upload of two textures. No instances: software renderers, and some
// GPUs, take far longer for many small ones than for one list of triangles.

const READ = `
precision highp float;
precision highp int;
uniform highp sampler2D uNow, uFirst, uValue;
uniform int uAcross;
uniform float uScale;
ivec2 cell(int i) { return ivec2(i % uAcross, i / uAcross); }
// Corner of the square -1..1, from the number 0..5 of a vertex of two triangles.
vec2 square(int k) { return vec2(k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, k >= 2 && k != 3 ? 1.0 : -1.0); }
// Place of a point, its displacement enlarged, and the radius.
vec4 place(int i) {
  vec4 now = texelFetch(uNow, cell(i), 0), first = texelFetch(uFirst, cell(i), 0);
  return vec4(first.xyz + uScale * (now.xyz - first.xyz), now.w);
}
`;

const COLOR = `
uniform sampler2D uMap;
uniform vec2 uRange;
uniform float uCategories;
vec3 colorOf(float value) {
  float share = uCategories > 0.0 ? (mod(floor(value + 0.5), uCategories) + 0.5) / uCategories
                                  : clamp((value - uRange.x) / max(uRange.y - uRange.x, 1e-30), 0.001, 0.999);
  return texture(uMap, vec2(share, 0.5)).rgb;
}
`;

// Bodies: 0 hidden, 1 solid, 2 seen through.
const BODY = `
uniform float uBody[16];
uniform float uWanted;
bool wanted(float group) { return abs(uBody[int(min(group, 15.0) + 0.5)] - uWanted) < 0.5; }
`;

const LIGHT = `
vec3 lit(vec3 color, vec3 n) {
  float sun = max(dot(n, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  return color * (0.42 + 0.16 * sky + 0.50 * sun);
}
`;

export const spheres = {
  vertex: READ + BODY + `
flat out vec3 vCenter;
flat out float vRadius, vValue;
out vec2 vAt;
void main() {
  int item = gl_VertexID / 6;
  vec2 corner = square(gl_VertexID % 6);
  vec4 p = place(item);
  vec2 value = texelFetch(uValue, cell(item), 0).rg;
  vec4 center = modelViewMatrix * vec4(p.xyz, 1.0);
  vRadius = wanted(value.g) ? p.w : 0.0;
  vCenter = center.xyz;
  vValue = value.r;
  vAt = corner;
  gl_Position = projectionMatrix * vec4(center.xy + vRadius * corner, center.z, 1.0);
}`,
  // A ray along -z meets the sphere, or the flat face that the clip plane leaves of it.
  fragment: `precision highp float;
` + COLOR + LIGHT + `
uniform mat4 projectionMatrix;
uniform vec4 uClip; // in the frame of the camera; no cut: w very large
uniform float uThrough;
flat in vec3 vCenter;
flat in float vRadius, vValue;
in vec2 vAt;
out vec4 color;
void main() {
  float d2 = dot(vAt, vAt);
  if (d2 > 1.0 || vRadius <= 0.0) discard;
  vec3 n = vec3(vAt, sqrt(1.0 - d2));
  vec3 p = vCenter + vRadius * n;
  bool flatFace = false;
  if (dot(uClip.xyz, p) > uClip.w) {
    if (uClip.z < 1e-4) discard;
    float z = (uClip.w - dot(uClip.xy, p.xy)) / uClip.z;
    if (z < vCenter.z - vRadius * n.z) discard;
    p.z = z;
    n = uClip.xyz;
    flatFace = true;
  }
  vec3 base = colorOf(vValue);
  if (uThrough > 0.5) {
    float rim = 1.0 - n.z;
    color = vec4(base * 0.85, 0.02 + 0.16 * rim * rim * rim);
  } else {
    float edge = flatFace ? 1.0 : 0.62 + 0.38 * smoothstep(0.0, 0.45, n.z);
    color = vec4((flatFace ? base * 0.97 : lit(base, n)) * edge, 1.0);
  }
  float depth = projectionMatrix[2][2] * p.z + projectionMatrix[3][2];
  gl_FragDepth = 0.5 * depth + 0.5;
}`,
};

// Links as ribbons that face the camera, shaded as round bars. uLines holds two ends, kind and
// state in one number (8 kind + state), and a share that widens the ribbon.
export const links = {
  vertex: READ + BODY + `
uniform highp sampler2D uLines;
uniform int uLinesAcross, uStyle; // style 0: bars of steel, 1: kind, 2: force
uniform float uWidth;
flat out int vKind, vState;
flat out float vShare;
out float vSide;
out vec3 vAlong, vPoint;
void main() {
  int item = gl_VertexID / 6;
  vec2 corner = square(gl_VertexID % 6);
  float side_ = corner.x, share_ = 0.5 + 0.5 * corner.y;
  vec4 line = texelFetch(uLines, ivec2(item % uLinesAcross, item / uLinesAcross), 0);
  int code = int(line.z + 0.5);
  vKind = code / 8;
  vState = code % 8;
  vShare = line.w;
  float width = uWidth;
  bool shown = true;
  if (uStyle == 1) width *= vKind == 1 ? 1.0 : 0.55;
  if (uStyle == 2) width *= 2.0 * sqrt(vShare);
  float ga = texelFetch(uValue, cell(int(line.x + 0.5)), 0).g;
  if (uBody[int(min(ga, 15.0) + 0.5)] < 0.5) shown = false;
  vec3 a = (modelViewMatrix * vec4(place(int(line.x + 0.5)).xyz, 1.0)).xyz;
  vec3 b = (modelViewMatrix * vec4(place(int(line.y + 0.5)).xyz, 1.0)).xyz;
  vec3 along = b - a;
  vec2 side = length(along.xy) > 1e-12 ? normalize(vec2(-along.y, along.x)) : vec2(1.0, 0.0);
  vec3 p = mix(a, b, share_);
  p.xy += side * side_ * (shown ? width : 0.0);
  vSide = side_;
  vAlong = normalize(along + vec3(0.0, 0.0, 1e-9));
  vPoint = p;
  gl_Position = projectionMatrix * vec4(p, 1.0);
  if (!shown) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`,
  fragment: `precision highp float;
precision highp int;
` + LIGHT + `
uniform int uStyle;
uniform vec4 uClip;
uniform sampler2D uMap;
flat in int vKind, vState;
flat in float vShare;
in float vSide;
in vec3 vAlong, vPoint;
out vec4 color;
void main() {
  if (dot(uClip.xyz, vPoint) > uClip.w) discard;
  vec3 base = vKind == 1 ? vec3(0.29, 0.47, 0.66) : vKind == 2 ? vec3(0.24, 0.60, 0.55) : vec3(0.55, 0.53, 0.49);
  if (uStyle != 2 && vState == 1) base = vKind == 1 ? vec3(0.90, 0.55, 0.13) : vec3(0.93, 0.65, 0.25);
  if (uStyle == 2) base = mix(vec3(0.45, 0.62, 0.80), vec3(0.72, 0.09, 0.10), smoothstep(0.05, 0.7, vShare));
  vec3 across = normalize(vec3(-vAlong.y, vAlong.x, 0.0) + vec3(1e-9, 0.0, 0.0));
  vec3 n = normalize(vSide * across + sqrt(max(0.0, 1.0 - vSide * vSide)) * vec3(0.0, 0.0, 1.0));
  color = vec4(lit(base, n), 1.0);
}`,
};

// Broken links as discs across the line where the link was.
export const cracks = {
  vertex: READ + BODY + `
uniform highp sampler2D uLines;
uniform int uLinesAcross;
flat out int vKind;
out vec3 vNormal, vPoint;
void main() {
  // A fan of 6 triangles: 18 vertices a disc.
  int item = gl_VertexID / 18, k = gl_VertexID % 18;
  float angle = (float(k / 3) + (k % 3 == 2 ? 1.0 : 0.0)) * 1.0471976;
  vec2 corner = k % 3 == 0 ? vec2(0.0) : vec2(cos(angle), sin(angle));
  vec4 line = texelFetch(uLines, ivec2(item % uLinesAcross, item / uLinesAcross), 0);
  int code = int(line.z + 0.5), ia = int(line.x + 0.5), ib = int(line.y + 0.5);
  vKind = code / 8;
  vec4 a = place(ia), b = place(ib);
  vec3 a0 = texelFetch(uFirst, cell(ia), 0).xyz, b0 = texelFetch(uFirst, cell(ib), 0).xyz;
  float ga = texelFetch(uValue, cell(ia), 0).g;
  bool shown = distance(texelFetch(uNow, cell(ia), 0).xyz, texelFetch(uNow, cell(ib), 0).xyz) < 1.6 * distance(a0, b0)
               && uBody[int(min(ga, 15.0) + 0.5)] > 0.5;
  vec3 n = normalize(b0 - a0);
  vec3 u = normalize(cross(n, abs(n.z) < 0.8 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  vec3 v = cross(n, u);
  float r = min(a.w, b.w);
  vec4 p = modelViewMatrix * vec4(0.5 * (a.xyz + b.xyz) + r * (corner.x * u + corner.y * v), 1.0);
  vNormal = (modelViewMatrix * vec4(n, 0.0)).xyz;
  vPoint = p.xyz;
  gl_Position = shown ? projectionMatrix * p : vec4(2.0, 2.0, 2.0, 1.0);
}`,
  fragment: `precision highp float;
precision highp int;
uniform vec4 uClip;
flat in int vKind;
in vec3 vNormal, vPoint;
out vec4 color;
void main() {
  if (dot(uClip.xyz, vPoint) > uClip.w) discard;
  vec3 base = vKind == 2 ? vec3(0.20, 0.52, 0.80) : vKind == 1 ? vec3(0.10, 0.12, 0.16) : vec3(0.80, 0.11, 0.13);
  color = vec4(base * (0.55 + 0.45 * abs(normalize(vNormal).z)), 1.0);
}`,
};

export const triangles = {
  vertex: READ + BODY + `
flat out float vValue;
out vec3 vShare;
void main() {
  int corner = gl_VertexID % 3;
  vec4 p = place(gl_VertexID);
  vec2 value = texelFetch(uValue, cell(gl_VertexID / 3), 0).rg;
  vValue = value.r;
  vShare = vec3(corner == 0, corner == 1, corner == 2);
  gl_Position = wanted(value.g) ? projectionMatrix * modelViewMatrix * vec4(p.xy, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}`,
  fragment: `precision highp float;
` + COLOR + `
uniform float uMesh, uThrough;
flat in float vValue;
in vec3 vShare;
out vec4 color;
void main() {
  vec3 base = colorOf(vValue);
  vec3 wide = fwidth(vShare);
  float pixel = max(wide.x, max(wide.y, wide.z)); // one over the height of the triangle in pixels
  vec3 inside = smoothstep(vec3(0.0), 1.2 * wide, vShare);
  float edge = 1.0 - min(inside.x, min(inside.y, inside.z));
  float strength = uMesh * (1.0 - smoothstep(0.05, 0.2, pixel));
  color = vec4(mix(base, base * 0.72, edge * strength), uThrough > 0.5 ? 0.25 : 1.0);
}`,
};

// Of a crack by its mode, 0 opened to 1 slid; below 0: open from the start.
const CRACK = `
vec3 crackColor(float mode) {
  if (mode < -0.3) return vec3(0.45, 0.30, 0.14);
  return mix(vec3(0.78, 0.05, 0.13), vec3(0.05, 0.30, 0.72), smoothstep(0.25, 0.75, mode));
}`;

// Joints of a plane that have softened or broken; uEnds holds both ends, uLines damage and mode.
export const joints = {
  vertex: `
precision highp float;
precision highp int;
uniform highp sampler2D uEnds, uLines;
uniform int uLinesAcross;
uniform float uPixel;
flat out vec2 vLine;
void main() {
  int item = gl_VertexID / 6, k = gl_VertexID % 6;
  vec2 corner = vec2(k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, k >= 2 && k != 3 ? 1.0 : 0.0);
  ivec2 cell = ivec2(item % uLinesAcross, item / uLinesAcross);
  vec4 ends = texelFetch(uEnds, cell, 0);
  vLine = texelFetch(uLines, cell, 0).xy;
  vec2 along = ends.zw - ends.xy;
  vec2 unit = length(along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
  float width = uPixel * (vLine.x > 0.985 ? 1.5 : 0.9);
  vec2 p = mix(ends.xy, ends.zw, corner.y) + vec2(-unit.y, unit.x) * corner.x * width + unit * (corner.y - 0.5) * width;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(p, 0.001 * uPixel, 1.0);
}`,
  fragment: `precision highp float;
` + CRACK + `
flat in vec2 vLine;
out vec4 color;
void main() {
  if (vLine.x > 0.985) color = vec4(crackColor(vLine.y), 1.0);
  else color = vec4(0.89, 0.47, 0.10, 0.25 + 0.65 * vLine.x);
}`,
};

// Forces of contacts as ribbons that face the camera, over what they are in. Two cells of uEnds a contact: its ends, with
// the share of the largest force.
export const contacts = {
  vertex: `
precision highp float;
precision highp int;
uniform highp sampler2D uEnds;
uniform int uLinesAcross;
uniform float uPixel, uWidth;
flat out float vShare;
out vec3 vPoint;
void main() {
  int item = gl_VertexID / 6, k = gl_VertexID % 6;
  float side = k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, end = k >= 2 && k != 3 ? 1.0 : 0.0;
  int cell = 2 * item;
  vec4 from = texelFetch(uEnds, ivec2(cell % uLinesAcross, cell / uLinesAcross), 0);
  vec4 to = texelFetch(uEnds, ivec2((cell + 1) % uLinesAcross, (cell + 1) / uLinesAcross), 0);
  vShare = from.w;
  vec3 a = (modelViewMatrix * vec4(from.xyz, 1.0)).xyz, b = (modelViewMatrix * vec4(to.xyz, 1.0)).xyz;
  vec2 along = b.xy - a.xy;
  vec2 across = length(along) > 1e-12 ? normalize(vec2(-along.y, along.x)) : vec2(1.0, 0.0);
  vPoint = mix(a, b, end);
  vec3 p = vPoint;
  p.xy += side * across * max(0.5 * uPixel, uWidth * vShare);
  gl_Position = projectionMatrix * vec4(p, 1.0);
}`,
  fragment: `precision highp float;
uniform vec4 uClip;
flat in float vShare;
in vec3 vPoint;
out vec4 color;
void main() {
  if (dot(uClip.xyz, vPoint) > uClip.w) discard;
  color = vec4(mix(vec3(0.30, 0.48, 0.72), vec3(0.72, 0.09, 0.10), smoothstep(0.05, 0.7, vShare)), 0.35 + 0.65 * sqrt(vShare));
}`,
};

// Bolts as ribbons of some pixels that face the camera, as wide as their forces; the colours are those of the program's own
// pictures (overlay.cpp): pulled, and pressed.
export const bolts = {
  vertex: contacts.vertex.replace("uPixel, uWidth", "uPixel").replace("max(0.5 * uPixel, uWidth * vShare)", "uPixel * (1.2 + 1.8 * abs(vShare))"),
  fragment: `precision highp float;
uniform vec4 uClip;
flat in float vShare;
in vec3 vPoint;
out vec4 color;
void main() {
  if (dot(uClip.xyz, vPoint) > uClip.w) discard;
  color = vec4(vShare < 0.0 ? vec3(0.36, 0.20, 0.62) : vec3(0.86, 0.33, 0.05), 1.0);
}`,
};

// Tetrahedra: of each pair in uValue the second number is body + 65536 * faces that can be seen.
const SOLID = READ + BODY + `
int corners(int face, int k) {
  int all = face == 0 ? 0x321 : face == 1 ? 0x230 : face == 2 ? 0x310 : 0x120; // counter-clockwise from outside
  return all >> (4 * k) & 15;
}
bool wantedPair(float pair) { return wanted(mod(pair, 65536.0)); }
vec3 seen(int item, int corner) { return (modelViewMatrix * vec4(place(4 * item + corner).xyz, 1.0)).xyz; }
`;

export const faces = {
  vertex: SOLID + `
uniform float uWithin; // faces inside can be seen: displacements are enlarged, or a body is not drawn
flat out float vValue;
flat out vec3 vNormal;
out vec3 vShare, vPoint;
void main() {
  int item = gl_VertexID / 12, face = gl_VertexID % 12 / 3, k = gl_VertexID % 3;
  vec2 value = texelFetch(uValue, cell(item), 0).rg;
  bool shown = wantedPair(value.g) && ((uWithin > 0.5 && uWanted < 1.5) || (int(value.g / 65536.0) >> face & 1) == 1);
  vec3 p[3] = vec3[3](seen(item, corners(face, 0)), seen(item, corners(face, 1)), seen(item, corners(face, 2)));
  vNormal = normalize(cross(p[1] - p[0], p[2] - p[0]) + vec3(0.0, 0.0, 1e-30));
  vPoint = p[k];
  vValue = value.r;
  vShare = vec3(k == 0, k == 1, k == 2);
  gl_Position = shown ? projectionMatrix * vec4(p[k], 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}`,
  fragment: `precision highp float;
` + COLOR + LIGHT + `
uniform vec4 uClip;
uniform float uMesh, uThrough;
flat in float vValue;
flat in vec3 vNormal;
in vec3 vShare, vPoint;
out vec4 color;
void main() {
  if (dot(uClip.xyz, vPoint) > uClip.w) discard;
  vec3 base = colorOf(vValue);
  vec3 wide = fwidth(vShare);
  float pixel = max(wide.x, max(wide.y, wide.z)); // one over the height of the triangle in pixels
  vec3 inside = smoothstep(vec3(0.0), 1.2 * wide, vShare);
  float edge = 1.0 - min(inside.x, min(inside.y, inside.z));
  float strength = uMesh * (1.0 - smoothstep(0.05, 0.2, pixel));
  vec3 drawn = mix(base, base * 0.78, edge * strength);
  if (uThrough > 0.5) color = vec4(drawn * 0.85, 0.06 + 0.10 * (1.0 - abs(vNormal.z)));
  else color = vec4(mix(lit(drawn, vNormal), drawn, 0.35), 1.0);
}`,
};

// The section of each tetrahedron with the plane of the cut: a triangle or a quadrangle.
export const sections = {
  vertex: SOLID + `
uniform vec4 uClip;
flat out float vValue;
vec3 between(vec3 a, vec3 b, float da, float db) { return a + (da / (da - db)) * (b - a); }
void main() {
  int item = gl_VertexID / 6, k = gl_VertexID % 6;
  vec2 value = texelFetch(uValue, cell(item), 0).rg;
  vValue = value.r;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (!wantedPair(value.g)) return;
  vec3 p[4];
  float d[4];
  int kept[4], lost[4], ofKept = 0, ofLost = 0;
  for (int c = 0; c < 4; ++c) {
    p[c] = seen(item, c);
    d[c] = dot(uClip.xyz, p[c]) - uClip.w;
    if (d[c] <= 0.0) kept[ofKept++] = c;
    else lost[ofLost++] = c;
  }
  if (ofKept == 0 || ofLost == 0) return;
  // The edge that corner number 0 to 3 of the section lies on.
  int n = k < 3 ? k : k == 3 ? 0 : k - 2, a, b;
  if (ofKept == 2) {
    a = kept[n / 2];
    b = lost[n == 1 || n == 2 ? 1 : 0];
  } else {
    if (k >= 3) return;
    a = ofKept == 1 ? kept[0] : kept[n];
    b = ofKept == 1 ? lost[n] : lost[0];
  }
  gl_Position = projectionMatrix * vec4(between(p[a], p[b], d[a], d[b]), 1.0);
}`,
  fragment: `precision highp float;
` + COLOR + `
flat in float vValue;
out vec4 color;
void main() { color = vec4(colorOf(vValue) * 0.95, 1.0); }`,
};

// Joints of tetrahedra that have softened or broken: a face, and its edges as ribbons that show on the surface.
// uEnds holds three corners, uLines damage and mode.
export const faceJoints = {
  vertex: `
precision highp float;
precision highp int;
uniform highp sampler2D uEnds, uLines;
uniform int uLinesAcross;
uniform float uPixel;
flat out vec2 vLine;
flat out vec3 vNormal;
out vec3 vPoint;
ivec2 texel(int i) { return ivec2(i % uLinesAcross, i / uLinesAcross); }
vec3 seen(int i) { return (modelViewMatrix * vec4(texelFetch(uEnds, texel(i), 0).xyz, 1.0)).xyz; }
void main() {
  int item = gl_VertexID / 21, k = gl_VertexID % 21;
  vLine = texelFetch(uLines, texel(item), 0).xy;
  vec3 p[3] = vec3[3](seen(3 * item), seen(3 * item + 1), seen(3 * item + 2));
  vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
  vNormal = length(normal) > 0.0 ? normalize(normal) : vec3(0.0, 0.0, 1.0);
  vec3 at = p[k % 3];
  if (k >= 3) {
    int edge = (k - 3) / 6, c = (k - 3) % 6;
    vec2 corner = vec2(c == 1 || c == 2 || c == 4 ? 1.0 : -1.0, c >= 2 && c != 3 ? 1.0 : 0.0);
    vec3 a = p[edge], b = p[(edge + 1) % 3], along = b - a;
    vec2 unit = length(along.xy) > 1e-12 ? normalize(along.xy) : vec2(1.0, 0.0);
    float width = uPixel * (vLine.x > 0.985 ? 1.3 : 0.8);
    at = mix(a, b, corner.y) + vec3(vec2(-unit.y, unit.x) * corner.x * width, 2.0 * uPixel);
    vNormal = vec3(0.0, 0.0, 1.0);
  }
  vPoint = at;
  gl_Position = projectionMatrix * vec4(at, 1.0);
}`,
  fragment: `precision highp float;
` + CRACK + `
uniform vec4 uClip;
uniform float uPixel;
flat in vec2 vLine;
flat in vec3 vNormal;
in vec3 vPoint;
out vec4 color;
void main() {
  if (dot(uClip.xyz, vPoint) > uClip.w + 2.0 * uPixel) discard;
  vec3 base = crackColor(vLine.y);
  float light = 0.6 + 0.4 * abs(vNormal.z);
  if (vLine.x > 0.985) color = vec4(base * light, 1.0);
  else color = vec4(vec3(0.89, 0.47, 0.10) * light, 0.25 + 0.65 * vLine.x);
}`,
};
