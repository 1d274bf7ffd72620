// Nearest face under a place of the picture, and edge beside the place.

/** Distance in pixels within which an edge is taken. */
const BESIDE = 7;

/** Depth by which an edge may lie behind the face that it bounds. */
const BEHIND = 0.004;

/** Points as they are seen: pixels to the right and down, and depth. */
function seen({ points, real, imaginary }, [forward, back], matrix, width, height) {
  const moved = real ? points.map((value, k) => value + forward * real[k] - (imaginary ? back * imaginary[k] : 0)) : points;
  const out = new Float32Array(points.length);
  const row = (k, x, y, z) => matrix[k] * x + matrix[4 + k] * y + matrix[8 + k] * z + matrix[12 + k];
  for (let k = 0; k < points.length; k += 3) {
    const [x, y, z] = [moved[k], moved[k + 1], moved[k + 2]];
    const w = row(3, x, y, z);
    out[k] = (row(0, x, y, z) / w + 1) / 2 * width;
    out[k + 1] = (1 - row(1, x, y, z) / w) / 2 * height;
    out[k + 2] = row(2, x, y, z) / w;
  }
  return out;
}

/** The nearest triangle that looks at the reader and is not cut away, and its depth. */
function face(at, { points, triangles }, cut, x, y) {
  let found = -1;
  let depth = Infinity;
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [3 * triangles[k], 3 * triangles[k + 1], 3 * triangles[k + 2]];
    const side = (p, q) => (at[q] - at[p]) * (y - at[p + 1]) - (at[q + 1] - at[p + 1]) * (x - at[p]);
    // Down is positive, so that corners that are counter-clockwise turn the other way.
    const [one, two, three] = [side(a, b), side(b, c), side(c, a)];
    if (one > 0 || two > 0 || three > 0 || (cut && cut[0] * points[a] + cut[1] * points[a + 1] < 0)) continue;
    const sum = one + two + three;
    if (sum === 0) continue;
    const here = (two * at[a + 2] + three * at[b + 2] + one * at[c + 2]) / sum;
    if (here < depth) [found, depth] = [k / 3, here];
  }
  return { found, depth };
}

/** The nearest chain beside the place that is not behind a face. */
function edge(at, chains, x, y, depth) {
  let found = -1;
  let least = BESIDE;
  chains.forEach((chain, number) => {
    for (let k = 1; k < chain.length; k += 1) {
      const [a, b] = [3 * chain[k - 1], 3 * chain[k]];
      const [dx, dy] = [at[b] - at[a], at[b + 1] - at[a + 1]];
      const part = Math.max(0, Math.min(1, ((x - at[a]) * dx + (y - at[a + 1]) * dy) / (dx * dx + dy * dy || 1)));
      const away = Math.hypot(at[a] + part * dx - x, at[a + 1] + part * dy - y);
      if (away < least && at[a + 2] + part * (at[b + 2] - at[a + 2]) < depth + BEHIND) [found, least] = [number, away];
    }
  });
  return found;
}

/**
 * The triangle and the chain under a place; -1 where there is none.
 * @param {{points: Float32Array, triangles: Uint32Array, chains?: number[][], real?: Float32Array, imaginary?: Float32Array}} body
 * @param {Float32Array} matrix from its coordinates to those of the picture
 * @param {{x: number, y: number, width: number, height: number}} place in pixels
 * @param {{phase: number[], cut: number[] | null}} drawn factors of its displacement, and a plane through the axis behind which all is drawn
 */
export function under(body, matrix, { x, y, width, height }, { phase, cut }) {
  const at = seen(body, phase, matrix, width, height);
  const { found, depth } = face(at, body, cut, x, y);
  return { triangle: found, chain: edge(at, body.chains ?? [], x, y, depth), at };
}
