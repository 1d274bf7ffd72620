// VTK's PolyData as the service writes it: XML with arrays in base64.

const TYPES = {
  Float64: Float64Array, Int32: Int32Array, Int64: BigInt64Array, UInt64: BigUint64Array, UInt8: Uint8Array,
};

/** Bytes before an array: its length. */
const HEADER = 8;

function bytesOf(text) {
  const trimmed = text.trim();
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(trimmed);
  const binary = atob(trimmed);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; k += 1) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/**
 * A surface.
 * @param {string} text
 * @returns {{points: Float64Array, triangles: Uint32Array, edges: Uint32Array, arrays: Map<string, any>, notes: string[]}}
 *   points as x, y, z; three points a triangle; two points an edge of a face; point data by name
 */
export function readSurface(text) {
  const xml = new DOMParser().parseFromString(text, 'application/xml');
  if (xml.querySelector('parsererror')) throw new Error('the file of the wheel is not valid XML');
  const array = (element) => {
    const bytes = bytesOf(element.textContent);
    return new TYPES[element.getAttribute('type')](bytes.buffer.slice(HEADER));
  };
  const arrays = new Map();
  for (const element of xml.querySelectorAll('PointData > DataArray')) arrays.set(element.getAttribute('Name'), element);
  const lazy = new Map();
  const read = {
    has: (name) => arrays.has(name),
    get(name) {
      if (!lazy.has(name)) lazy.set(name, array(arrays.get(name)));
      return lazy.get(name);
    },
  };
  const polys = (name) => {
    const element = xml.querySelector(`Polys > DataArray[Name="${name}"]`);
    return element ? array(element) : new BigInt64Array(0);
  };
  const points = array(xml.querySelector('Points > DataArray'));
  const notes = [...xml.childNodes].filter((node) => node.nodeType === Node.COMMENT_NODE).flatMap((node) => node.textContent.trim().split('\n'));
  return { points, ...faces(polys('connectivity'), polys('offsets')), arrays: read, notes };
}

function faces(connectivity, offsets) {
  const triangles = [];
  const edges = [];
  const seen = new Set();
  let begin = 0;
  for (const offset of offsets) {
    const end = Number(offset);
    for (let k = begin; k < end; k += 1) {
      const [a, b] = [Number(connectivity[k]), Number(connectivity[k + 1 < end ? k + 1 : begin])];
      const key = a < b ? a * 2 ** 26 + b : b * 2 ** 26 + a;
      if (!seen.has(key)) {
        seen.add(key);
        edges.push(a, b);
      }
      if (k > begin + 1) triangles.push(Number(connectivity[begin]), Number(connectivity[k - 1]), a);
    }
    begin = end;
  }
  return { triangles: new Uint32Array(triangles), edges: new Uint32Array(edges) };
}
