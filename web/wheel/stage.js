// A canvas on which bodies are turned by mouse, fingers and keys. It draws only when something has changed.

import { h } from '../lib/dom.js';
import { colour, onTheme } from '../lib/theme.js';
import { camera } from './camera.js';
import { overlay } from './overlay.js';
import { under } from './pick.js';
import { renderer } from './renderer.js';

/** Revolutions of the phase a second while it is animated. */
const PACE = 0.8;

/** Milliseconds without a movement after which everything is drawn, also what is slow. */
const REST = 150;

/** Pixels of the screen for each of the page, at most. */
const DENSITY = 2;

/** A colour of the theme as red, green, blue from 0 to 1. */
export function rgb(name) {
  const context = h('canvas', { width: 1, height: 1 }).getContext('2d');
  context.fillStyle = colour(name);
  context.fillRect(0, 0, 1, 1);
  return [...context.getImageData(0, 0, 1, 1).data.slice(0, 3)].map((part) => part / 255);
}

/**
 * A stage; nothing where the browser cannot draw in 3D.
 * @param {{label: string, middle: number, radius: number, front: boolean, axes?: number[][], unit?: string}} what the label for those who do not see it, what the
 *   camera is about, the directions x, y and z of the reader's coordinates, and the unit of length
 * @param {AbortSignal} signal
 */
export function stage({ label, middle, radius, front, axes, unit }, signal) {
  const canvas = h('canvas', { class: 'stage', tabindex: '0', role: 'application', 'aria-label': `${label}. Arrow keys turn it, plus and minus zoom, 0 resets the view.` });
  const drawn = renderer(canvas);
  if (!drawn) return null;
  const eye = camera(middle, radius, front);
  const over = overlay(axes, unit);
  const state = { scale: 0, angle: 0, pace: PACE, weights: (angle) => [Math.cos(angle), Math.sin(angle)], spin: 0, cut: null, limit: Infinity, playing: false, hidden: new Set(), asked: false, last: 0, resting: 0 };
  let ground = rgb('ground');
  canvas.dataset.frames = '0';

  const phase = () => state.weights(state.angle).map((weight) => state.scale * weight);
  function frame(now) {
    state.asked = false;
    if (signal.aborted) return;
    const ratio = Math.min(DENSITY, devicePixelRatio);
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    if (state.playing) {
      state.angle += 2 * Math.PI * state.pace * Math.min(0.1, (now - state.last) / 1000);
      state.last = now;
      ask();
    }
    drawn.draw({ ...state, view: eye.view(), projection: eye.projection(width / height), phase: phase(), ground, moving: state.resting !== 0 || state.playing });
    over.draw(eye, canvas.clientWidth, canvas.clientHeight);
    canvas.dataset.frames = String(Number(canvas.dataset.frames) + 1);
  }
  function ask() {
    if (state.asked || signal.aborted) return;
    state.asked = true;
    requestAnimationFrame(frame);
  }
  const moved = (f) => (...values) => {
    f(...values);
    ask();
  };
  const moving = (f) => moved((...values) => {
    f(...values);
    clearTimeout(state.resting);
    state.resting = setTimeout(() => {
      state.resting = 0;
      ask();
    }, REST);
  });
  handle(canvas, { turn: moving(eye.turn), shift: moving(eye.shift), zoom: moving(eye.zoom), reset: moved(eye.reset) });
  const sizes = new ResizeObserver(ask);
  sizes.observe(canvas);
  canvas.addEventListener('redraw', ask);
  onTheme(() => {
    ground = rgb('ground');
    ask();
  }, signal);
  signal.addEventListener('abort', () => {
    sizes.disconnect();
    drawn.end();
  });
  return {
    canvas,
    element: h('div', { class: 'stage-frame' }, canvas, over.element),
    reset: moved(eye.reset),
    /** The triangle and the chain of a body under the pointer, as it is drawn now. */
    under(body, event) {
      const box = canvas.getBoundingClientRect();
      const place = { x: event.clientX - box.left, y: event.clientY - box.top, width: box.width, height: box.height };
      return under(body, eye.through(box.width / box.height), place, { phase: phase(), cut: state.cut });
    },
    /** Marks a point of the picture, or none. */
    mark: moved(over.mark),
    show: moved(drawn.show),
    scale: moved((factor) => { state.scale = factor; }),
    /** Takes the half away that faces the reader, or puts it back. */
    halve: moved((on) => { state.cut = on ? eye.plane() : null; }),
    /** Stripes values above this share of the largest. */
    limit: moved((share) => { state.limit = share; }),
    /** Turns by an angle what turns against the wheel. */
    spin: moved((angle) => { state.spin = angle; }),
    /** Has every angle that is played give the weights of both displacements, at so many revolutions a second. */
    pace: moved((pace, weights) => { Object.assign(state, { pace, weights, angle: 0 }); }),
    hide: moved((name, on) => (on ? state.hidden.add(name) : state.hidden.delete(name))),
    play(on) {
      state.playing = on;
      state.last = performance.now();
      ask();
    },
  };
}

const KEYS = {
  ArrowLeft: ['turn', -0.1, 0], ArrowRight: ['turn', 0.1, 0], ArrowUp: ['turn', 0, -0.1], ArrowDown: ['turn', 0, 0.1],
  '+': ['zoom', 0.9], '=': ['zoom', 0.9], '-': ['zoom', 1.1], 0: ['reset'],
};

function handle(canvas, eye) {
  const fingers = new Map();
  canvas.addEventListener('keydown', (event) => {
    const found = KEYS[event.key];
    if (!found || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    eye[found[0]](...found.slice(1));
  });
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
  });
  const up = (event) => fingers.delete(event.pointerId);
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('pointermove', (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
    const other = [...fingers.values()].find((finger) => finger.pointerId !== event.pointerId);
    if (other) {
      const apart = (finger) => Math.hypot(finger.clientX - other.clientX, finger.clientY - other.clientY);
      eye.zoom(apart(before) / Math.max(1, apart(event)));
      eye.shift(dx / canvas.clientHeight, -dy / canvas.clientHeight);
    } else if (event.shiftKey || event.buttons === 4 || event.buttons === 2) {
      eye.shift(2 * dx / canvas.clientHeight, -2 * dy / canvas.clientHeight);
    } else {
      eye.turn(0.01 * dx, 0.01 * dy);
    }
    fingers.set(event.pointerId, event);
  });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    // The page scrolls past a wheel that nobody has taken hold of.
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    eye.zoom(event.deltaY > 0 ? 1.1 : 0.9);
  }, { passive: false });
}
