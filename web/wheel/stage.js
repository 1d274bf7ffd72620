// A canvas on which bodies are turned by mouse, fingers and keys. It draws only when something has changed.

import { h } from '../lib/dom.js';
import { colour, onTheme } from '../lib/theme.js';
import { camera } from './camera.js';
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
 * @param {{label: string, middle: number, radius: number, front: boolean}} what the label for those who do not see it, and what the camera is about
 * @param {AbortSignal} signal
 */
export function stage({ label, middle, radius, front }, signal) {
  const canvas = h('canvas', { class: 'stage', tabindex: '0', role: 'application', 'aria-label': `${label}. Arrow keys turn it, plus and minus zoom, 0 resets the view.` });
  const drawn = renderer(canvas);
  if (!drawn) return null;
  const eye = camera(middle, radius, front);
  const state = { scale: 0, angle: 0, playing: false, hidden: new Set(), asked: false, last: 0, resting: 0 };
  let ground = rgb('ground');
  canvas.dataset.frames = '0';

  function frame(now) {
    state.asked = false;
    if (signal.aborted) return;
    const ratio = Math.min(DENSITY, devicePixelRatio);
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    if (state.playing) {
      state.angle += 2 * Math.PI * PACE * Math.min(0.1, (now - state.last) / 1000);
      state.last = now;
      ask();
    }
    const phase = [state.scale * Math.cos(state.angle), state.scale * Math.sin(state.angle)];
    drawn.draw({ view: eye.view(), projection: eye.projection(width / height), phase, ground, hidden: state.hidden, moving: state.resting !== 0 || state.playing });
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
    reset: moved(eye.reset),
    /** From the coordinates of what is shown to those of the picture, by columns. */
    through: () => eye.through(canvas.clientWidth / canvas.clientHeight),
    show: moved(drawn.show),
    scale: moved((factor) => { state.scale = factor; }),
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
