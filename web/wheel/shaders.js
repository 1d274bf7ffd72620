// Programs of the graphics processor.

/** A point where it is, turned about the axis, moved by a displacement that turns with a phase. */
const VERTEX = `#version 300 es
in vec3 position;
in vec3 real;
in vec3 imaginary;
in float value;
uniform mat4 view;
uniform mat4 projection;
uniform vec2 phase;
uniform float nearer;
uniform float size;
uniform vec2 spin;
uniform vec4 cut;
out vec3 eye;
out float share;
out float left;
void main() {
  vec3 rest = vec3(spin.x * position.x - spin.y * position.y, spin.y * position.x + spin.x * position.y, position.z);
  vec3 moved = rest + real * phase.x - imaginary * phase.y;
  left = dot(cut, vec4(rest, 1.0));
  vec4 at = view * vec4(moved, 1.0);
  eye = at.xyz;
  share = value;
  gl_Position = projection * at;
  gl_Position.z -= nearer * gl_Position.w;
  gl_PointSize = size;
}`;

/** Faces, lit from the eye by their own plane, so that they need no normals while they move. Where a cut opens a skin, its inside is hatched
 * like a section; values above a limit are striped. */
const FACES = `#version 300 es
precision highp float;
in vec3 eye;
in float share;
in float left;
uniform sampler2D colours;
uniform vec4 plain;
uniform float limit;
uniform bool opened;
out vec4 colour;
void main() {
  if (left < 0.0) discard;
  bool stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 4.0;
  if (opened && !gl_FrontFacing) {
    colour = vec4(vec3(stripe ? 0.5 : 0.62), 1.0);
    return;
  }
  vec3 normal = normalize(cross(dFdx(eye), dFdy(eye)));
  float light = 0.35 + 0.65 * abs(dot(normal, normalize(eye)));
  vec3 own = share < 0.0 ? plain.rgb : texture(colours, vec2(clamp(share, 0.0, 1.0) * 0.99 + 0.005, 0.5)).rgb;
  if (share > limit && stripe) own = vec3(0.86, 0.08, 0.24);
  colour = vec4(own * light, plain.a);
}`;

const LINES = `#version 300 es
precision mediump float;
in float left;
uniform vec4 plain;
out vec4 colour;
void main() {
  if (left < 0.0) discard;
  colour = plain;
}`;

function compiled(gl, kind, source) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  return shader;
}

function linked(gl, fragment) {
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, VERTEX));
  gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, fragment));
  ATTRIBUTES.forEach((name, place) => gl.bindAttribLocation(program, place, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program));
  const at = (name) => gl.getUniformLocation(program, name);
  return { program, at: Object.fromEntries(['view', 'projection', 'phase', 'nearer', 'size', 'colours', 'plain', 'spin', 'cut', 'limit', 'opened'].map((name) => [name, at(name)])) };
}

/** What every point has, in the order of its places. */
export const ATTRIBUTES = ['position', 'real', 'imaginary', 'value'];

/** The programs for faces and for lines. */
export function programs(gl) {
  return { faces: linked(gl, FACES), lines: linked(gl, LINES) };
}
