// ---- What the graphics card computes: light and shadow of surfaces, the grid of planes, lines ----

const SHADE = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
uniform sampler2DShadow shadow;
uniform vec3 light, eye, up;

// The part of the light that arrives, softened over nine places of the map of shadows.
float lit(vec4 p, vec3 n) {
  vec3 q = p.xyz / p.w * 0.5 + 0.5;
  if (any(lessThan(q, vec3(0.0))) || any(greaterThan(q, vec3(1.0)))) return 1.0;
  float sum = 0.0, texel = 1.0 / float(textureSize(shadow, 0).x);
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++)
      sum += texture(shadow, vec3(q.xy + 1.4 * texel * vec2(i, j), q.z - 0.0008));
  return sum / 9.0;
}
vec3 linear(vec3 c) { return pow(c, vec3(2.2)); }
vec3 screen(vec3 c) { return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2)); }
`;

const SURFACE = {
  vertex: `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
uniform mat4 model, view, sun;
out vec3 world, own, n;
out vec4 sunned;
void main() {
  vec4 p = model * vec4(place, 1.0);
  world = p.xyz; own = place;
  mat3 a = mat3(model); // may be stretched along its axes: normals shrink where places grow
  n = a * (normal / vec3(dot(a[0], a[0]), dot(a[1], a[1]), dot(a[2], a[2])));
  sunned = sun * p;
  gl_Position = view * p;
}`,
  fragment: SHADE + `
in vec3 world, own, n;
in vec4 sunned;
uniform vec4 colour;
uniform float pattern; // 1: octants in two shades, which show that a round body turns
uniform float glow;    // 1: no light and shadow, for arrows
out vec4 result;
void main() {
  vec3 m = normalize(n), c = linear(colour.rgb);
  if (pattern > 0.5) {
    vec3 s = own / max(fwidth(own), vec3(1e-5 * length(own)));
    float side = clamp(s.x, -1.0, 1.0) * clamp(s.y, -1.0, 1.0) * clamp(s.z, -1.0, 1.0);
    c = mix(c, mix(c, vec3(1.0), 0.62), 0.5 + 0.5 * side);
  }
  float sky = 0.5 + 0.5 * dot(m, up), direct = max(dot(m, light), 0.0);
  float arrives = direct > 0.0 ? lit(sunned, m) : 0.0;
  vec3 half_way = normalize(light + normalize(eye - world));
  float shine = 0.12 * pow(max(dot(m, half_way), 0.0), 40.0) * arrives;
  vec3 shone = c * (mix(0.26, 0.52, sky) + 0.62 * direct * arrives) + shine;
  result = vec4(screen(mix(shone, c * (0.75 + 0.25 * sky), glow)), colour.a);
}`,
};

const PLANE = {
  vertex: `#version 300 es
layout(location = 0) in vec3 place;
uniform mat4 view, sun;
out vec3 world;
out vec4 sunned;
void main() { world = place; sunned = sun * vec4(place, 1.0); gl_Position = view * vec4(place, 1.0); }`,
  fragment: SHADE + `
in vec3 world;
in vec4 sunned;
uniform vec3 normal, along, beside, middle, tint;
uniform float cell, reach;
out vec4 result;
float lines(vec2 p) {
  vec2 w = fwidth(p), d = abs(fract(p - 0.5) - 0.5) / w;
  return (1.0 - min(min(d.x, d.y), 1.0)) * clamp(0.5 / max(w.x, w.y), 0.0, 1.0);
}
void main() {
  vec2 p = vec2(dot(world, along), dot(world, beside)) / cell;
  vec3 c = mix(vec3(0.955, 0.965, 0.973), vec3(0.80, 0.835, 0.865), 0.55 * lines(p));
  c = mix(c, vec3(0.66, 0.71, 0.75), 0.8 * lines(p / 5.0));
  float shadowed = 1.0 - lit(sunned, normal);
  c *= tint * (1.0 - 0.30 * shadowed);
  float away = length(world - middle) / reach;
  result = vec4(c, 1.0 - smoothstep(0.55, 1.0, away));
}`,
};

const LINE = {
  vertex: `#version 300 es
layout(location = 0) in vec3 place;
uniform mat4 view;
void main() { gl_Position = view * vec4(place, 1.0); }`,
  fragment: `#version 300 es
precision highp float;
uniform vec4 colour;
out vec4 result;
void main() { result = colour; }`,
};

const DEPTH = {
  vertex: `#version 300 es
layout(location = 0) in vec3 place;
uniform mat4 model, sun;
void main() { gl_Position = sun * model * vec4(place, 1.0); }`,
  fragment: `#version 300 es
precision highp float;
void main() {}`,
};

/** A program with its uniforms by name. */
function compiled(gl, { vertex, fragment }) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const at = {};
  for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); k++) {
    const { name } = gl.getActiveUniform(program, k);
    at[name] = gl.getUniformLocation(program, name);
  }
  return { program, at };
}
