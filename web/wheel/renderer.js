// Draws bodies: faces, edges and points that move together.

import { texels } from './colours.js';
import { ATTRIBUTES, programs } from './shaders.js';

/** Ends of lines that are drawn while something moves; more wait until it rests. */
const QUICK = 20_000;

const COMPONENTS = [3, 3, 3, 1];

/**
 * A renderer on a canvas; nothing where the browser has no WebGL 2. Without multisampling: software renderers are twice as fast so.
 * @param {HTMLCanvasElement} canvas
 */
export function renderer(canvas) {
  const gl = canvas.getContext('webgl2', { antialias: false, alpha: false, powerPreference: 'low-power' });
  if (!gl) return null;
  let bodies = [];
  let made = null;

  function prepare() {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    const bytes = texels();
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, bytes.length / 4, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) {
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    }
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    made = programs(gl);
    // What a body has not is 0 everywhere; its value is that of its own colour.
    gl.vertexAttrib3f(ATTRIBUTES.indexOf('real'), 0, 0, 0);
    gl.vertexAttrib3f(ATTRIBUTES.indexOf('imaginary'), 0, 0, 0);
    gl.vertexAttrib1f(ATTRIBUTES.indexOf('value'), -1);
    for (const body of bodies) body.buffers = buffers(gl, body);
  }
  canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
  canvas.addEventListener('webglcontextrestored', () => {
    prepare();
    canvas.dispatchEvent(new Event('redraw'));
  });
  prepare();

  return {
    /**
     * What is drawn, in this order: `points` (x, y, z each), `real` and `imaginary` displacement, `values` (0 to 1 along the colours, below 0 for the body's
     * own colour), `spins` (whether it turns against the wheel), and `parts`: {mode: 'triangles' | 'lines' | 'points', indices, colour: [r, g, b, a], nearer, size}.
     */
    show(list) {
      for (const body of bodies) body.buffers?.forget();
      bodies = list.map((body) => ({ ...body, buffers: buffers(gl, body) }));
    },
    draw({ view, projection, phase, spin, cut, limit, ground, hidden, moving }) {
      if (gl.isContextLost()) return;
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(...ground, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      for (const body of bodies) {
        gl.bindVertexArray(body.buffers.array);
        body.parts.forEach((part, number) => {
          if (hidden.has(part.name) || (moving && part.mode === 'lines' && part.indices.length > QUICK)) return;
          const { program, at } = part.mode === 'triangles' ? made.faces : made.lines;
          gl.useProgram(program);
          gl.uniformMatrix4fv(at.view, false, view);
          gl.uniformMatrix4fv(at.projection, false, projection);
          gl.uniform2f(at.phase, ...phase);
          gl.uniform1f(at.nearer, part.nearer ?? 0);
          gl.uniform1f(at.size, part.size ?? 1);
          gl.uniform4f(at.plain, ...part.colour);
          gl.uniform2f(at.spin, ...(body.spins ? [Math.cos(spin), Math.sin(spin)] : [1, 0]));
          gl.uniform4f(at.cut, ...(cut ?? [0, 0, 0, 1]));
          gl.uniform1f(at.limit, limit);
          const translucent = part.colour[3] < 1;
          gl.uniform1i(at.opened, Number(cut !== null && !translucent));
          if (translucent) gl.enable(gl.BLEND);
          // A skin is closed, and nobody sees its inside unless it is cut.
          if (!translucent && !cut) gl.enable(gl.CULL_FACE);
          gl.depthMask(!translucent);
          gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, body.buffers.indices[number]);
          gl.drawElements({ triangles: gl.TRIANGLES, lines: gl.LINES, points: gl.POINTS }[part.mode], part.indices.length, gl.UNSIGNED_INT, 0);
          gl.disable(gl.BLEND);
          gl.disable(gl.CULL_FACE);
          gl.depthMask(true);
        });
      }
      gl.bindVertexArray(null);
    },
    /** Gives the graphics processor back. */
    end() {
      gl.getExtension('WEBGL_lose_context')?.loseContext();
    },
  };
}

function buffers(gl, body) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const all = [];
  [body.points, body.real, body.imaginary, body.values].forEach((data, place) => {
    if (!data) return;
    const buffer = gl.createBuffer();
    all.push(buffer);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, COMPONENTS[place], gl.FLOAT, false, 0, 0);
  });
  const indices = body.parts.map((part) => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, part.indices, gl.STATIC_DRAW);
    return buffer;
  });
  gl.bindVertexArray(null);
  return {
    array,
    indices,
    forget() {
      for (const buffer of [...all, ...indices]) gl.deleteBuffer(buffer);
      gl.deleteVertexArray(array);
    },
  };
}
