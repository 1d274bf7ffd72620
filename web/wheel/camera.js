// From where the wheel is looked at: about its middle, from a distance. Matrices are by columns, as WebGL takes them.

/** Half of the angle that is seen, rad. */
const HALF = 0.35;

/** Tilt of the axis of rotation towards the reader at first, rad: 0 is along it. Blades do not hide each other's tips so. */
const TILT = 0.7;

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
 * A camera about a point of the axis for what lies within `radius` of it; at first on the side where z is positive if `front`. The side
 * that is looked at is up.
 * @param {number} middle its z
 * @param {number} radius
 * @param {boolean} front
 */
export function camera(middle, radius, front) {
  const up = front ? 1 : -1;
  const first = () => ({ around: 0.5, tilt: front ? TILT : Math.PI - TILT, far: 1, x: 0, y: 0 });
  let at = first();
  const distance = () => at.far * radius / Math.sin(HALF);
  return {
    turn(around, tilt) {
      at.around += up * around;
      at.tilt = Math.max(0, Math.min(Math.PI, at.tilt + up * tilt));
    },
    shift(x, y) {
      at.x += x * at.far;
      at.y += y * at.far;
    },
    zoom(factor) {
      at.far = Math.max(0.08, Math.min(5, at.far * factor));
    },
    reset() {
      at = first();
    },
    /** From the wheel's coordinates to those of the eye, which looks along −z. */
    view() {
      const [s, c] = [Math.sin(at.around), Math.cos(at.around)];
      const [t, u] = [-Math.sin(at.tilt), Math.cos(at.tilt)];
      const turned = new Float32Array([up * c, up * u * s, t * s, 0, -up * s, up * u * c, t * c, 0, 0, -up * t, u, 0, 0, 0, 0, 1]);
      const moved = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -middle, 1]);
      const view = multiply(turned, moved);
      view[12] += at.x * radius;
      view[13] += at.y * radius;
      view[14] -= distance();
      return view;
    },
    /** A plane through the axis, as a, b, c, d of ax + by + cz + d = 0; the reader is where that is negative. */
    plane: () => [Math.sin(at.around), Math.cos(at.around), 0, 0],
    /** Pixels of a length at the middle of the wheel, in a picture of this size. */
    pixels: (width, height) => height * Math.min(1, width / height) / (2 * Math.tan(HALF) * distance()),
    /** From the wheel's coordinates to those of a picture with this ratio of width to height. */
    through(aspect) {
      return multiply(this.projection(aspect), this.view());
    },
    /** Of a picture with this ratio of width to height. */
    projection(aspect) {
      const half = Math.tan(HALF) / Math.min(1, aspect);
      const near = Math.max(distance() - 1.6 * radius, 0.01 * distance());
      const far = distance() + 1.6 * radius;
      const depth = far - near;
      return new Float32Array([1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -(far + near) / depth, -1, 0, 0, -2 * far * near / depth, 0]);
    },
  };
}
