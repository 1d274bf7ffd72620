// From where the wheel is looked at: about its middle, from a distance. Matrices are by columns, as WebGL takes them.

/** Half of the angle that is seen, rad. */
const HALF = 0.35;

function multiply(a, b) {
  const product = new Float32Array(16);
  for (let column = 0; column < 4; column += 1) {
    for (let row = 0; row < 4; row += 1) {
      let sum = 0;
      for (let k = 0; k < 4; k += 1) sum += a[4 * k + row] * b[4 * column + k];
      product[4 * column + row] = sum;
    }
  }
  return product;
}

/**
 * A camera about `middle` for what lies within `radius` of it, at first from the side to which `towards` points, a little from above.
 */
export function camera(middle, radius, towards) {
  const first = () => ({ around: 0.5, up: 0.45 * towards, side: towards, far: 1, x: 0, y: 0 });
  let at = first();
  return {
    turn(dx, dy) {
      at.around += dx;
      at.up = Math.max(-1.57, Math.min(1.57, at.up + dy));
    },
    shift(dx, dy) {
      at.x += dx * at.far;
      at.y += dy * at.far;
    },
    zoom(factor) {
      at.far = Math.max(0.08, Math.min(5, at.far * factor));
    },
    reset() {
      at = first();
    },
    /** View: from the wheel's coordinates to those of the eye, which looks along −z; z of the wheel is the axis of rotation. */
    view() {
      // From along the axis, tilted.
      const [s, c] = [Math.sin(at.around), Math.cos(at.around)];
      const tilt = at.side > 0 ? 0.9 - at.up : Math.PI - 0.9 - at.up;
      const [t, u] = [Math.sin(-tilt), Math.cos(-tilt)];
      const turned = new Float32Array([c, u * s, t * s, 0, -s, u * c, t * c, 0, 0, -t, u, 0, 0, 0, 0, 1]);
      const moved = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -middle[0], -middle[1], -middle[2], 1]);
      const view = multiply(turned, moved);
      view[12] += at.x * radius;
      view[13] += at.y * radius;
      view[14] -= at.far * radius / Math.sin(HALF);
      return view;
    },
    /** Projection for a picture of this width by height. */
    projection(aspect) {
      const half = Math.tan(HALF) * (aspect < 1 ? 1 / aspect : 1);
      const distance = at.far * radius / Math.sin(HALF);
      const [near, far] = [Math.max(distance - 1.6 * radius, 0.01 * distance), distance + 1.6 * radius];
      return new Float32Array([1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0]);
    },
  };
}
