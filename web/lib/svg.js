// Drawings of the page: SVG elements, and lines through points.

/** An SVG element; children are elements or texts. */
export function s(tag, properties = {}, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(properties)) if (value !== null && value !== undefined) element.setAttribute(name, value);
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined).map((child) => (child instanceof Node ? child : String(child))));
  return element;
}

/** A drawing with its name for those who do not see it; it takes the width that there is. */
export function drawing(label, width, height, ...children) {
  return s('svg', { class: 'sketch', viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label }, children);
}

/** The path through points `[x, y]`. */
export function line(points, closed = false) {
  return points.map(([x, y], k) => `${k ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`).join('') + (closed ? 'Z' : '');
}

/** A text at a point. */
export function words(x, y, text, properties = {}) {
  return s('text', { x: x.toFixed(1), y: y.toFixed(1), ...properties }, text);
}
