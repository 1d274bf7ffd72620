// Figures. Plotly's script is large and is loaded when the first figure is shown.

import { Away } from './api.js';
import { colour, onTheme } from './theme.js';

/** Colours that the colour-blind tell apart, those of drawings and of the Python client. */
export const PALETTE = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8c8c8c'];

/** Pixels of height of a figure that does not say. */
const HEIGHT = 400;

let loading = null;

/** Plotly. */
export function plotly() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = document.querySelector('meta[name="plotly"]').content;
    script.addEventListener('load', () => resolve(globalThis.Plotly));
    script.addEventListener('error', () => {
      loading = null;
      reject(new Away('the script that draws figures could not be loaded'));
    });
    document.head.append(script);
  });
  return loading;
}

/** Colours of the theme, as a template that figures are drawn on. */
function template() {
  const line = colour('line');
  const axis = { gridcolor: line, linecolor: colour('edge'), zerolinecolor: line, automargin: true };
  return {
    layout: {
      paper_bgcolor: colour('ground'),
      plot_bgcolor: colour('ground'),
      font: { color: colour('text'), family: 'system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif', size: 13 },
      hoverlabel: { bgcolor: colour('raised'), bordercolor: colour('edge'), font: { color: colour('text') } },
      legend: { bgcolor: 'rgba(0,0,0,0)' },
      xaxis: axis,
      yaxis: axis,
      colorway: PALETTE,
    },
  };
}

/** A text of a figure in which nothing is markup, as Plotly takes some. */
export function plain(text) {
  return text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');
}

/** Whether a figure has little room. */
function narrow(element) {
  return element.clientWidth > 0 && element.clientWidth < 560;
}

/** Least distance of upright labels, and what stands beside the panels of a figure with a bar of colours, or without, pixels. */
const APART = 14;
const BESIDE = { bar: 200, none: 90 };

/** Annotations of a figure with the labels over upright lines moved apart for the width that there is; those without room are left out. */
function annotations({ annotations: all = [], xaxis, coloraxis }, width) {
  const range = xaxis?.range;
  const above = all.filter((one) => one.name === 'above');
  if (!range || above.length === 0) return all;
  const room = Math.max(100, width - (coloraxis ? BESIDE.bar : BESIDE.none));
  const at = above.map((one) => room * (one.x - range[0]) / (range[1] - range[0]));
  const most = Math.floor(room / APART);
  const kept = above.length <= most ? above : above.slice(0, most);
  const places = at.slice(0, kept.length);
  for (let k = 1; k < places.length; k += 1) places[k] = Math.max(places[k], places[k - 1] + APART);
  for (let k = places.length - 1, limit = room; k >= 0; k -= 1) {
    places[k] = Math.min(places[k], limit);
    limit = places[k] - APART;
  }
  return [...all.filter((one) => one.name !== 'above'), ...kept.map((one, k) => ({ ...one, ax: Math.round(places[k] - at[k]) }))];
}

function dressed(element, figure, height) {
  const layout = { ...figure.layout, template: template(), autosize: true };
  layout.height = height ?? layout.height ?? HEIGHT;
  if (layout.annotations) layout.annotations = annotations(layout, element.clientWidth);
  if (narrow(element)) {
    // A key beside the figure would leave no room for it; those of the service have theirs below.
    layout.legend = { orientation: 'h', y: -0.4, x: 0, yanchor: 'top', xanchor: 'left', ...layout.legend };
    layout.margin = { ...layout.margin, l: 48, r: 12 };
    if (layout.title) layout.title = { ...layout.title, font: { size: 13 } };
  }
  return layout;
}

const shown = new WeakMap();

/**
 * Shows a figure, or another in the place of the one that is shown: what was zoomed stays so where the figure has a `uirevision`.
 * @param {HTMLElement} element
 * @param {{data: any[], layout: any}} figure
 * @param {{onClick?: (event: any) => void, height?: number, signal?: AbortSignal, label?: string}} [options]
 */
export async function plot(element, figure, { onClick, height, signal, label } = {}) {
  const Plotly = await plotly();
  if (signal?.aborted || !element.isConnected) return;
  const config = { displaylogo: false, responsive: true, topojsonURL: '', modeBarButtonsToRemove: ['sendDataToCloud', 'lasso2d', 'select2d'] };
  const draw = () => Plotly.react(element, figure.data, dressed(element, figure, height), config);
  await draw();
  element.setAttribute('role', 'group');
  element.setAttribute('aria-label', label ?? titleOf(figure));
  if (!shown.has(element)) {
    const state = { draw };
    shown.set(element, state);
    onTheme(() => element.isConnected && state.draw(), signal);
    signal?.addEventListener('abort', () => Plotly.purge(element));
  }
  shown.get(element).draw = draw;
  element.removeAllListeners?.('plotly_click');
  if (onClick) element.on('plotly_click', onClick);
}

function titleOf(figure) {
  const title = figure.layout?.title;
  return (typeof title === 'string' ? title : title?.text) ?? 'Figure';
}
