// What was measured: a table of speed, frequency and amplitude, with a header that says which column is which.

import { rpm } from '../../lib/format.js';
import { lengthIn } from '../../lib/units.js';

/** What turns a unit of speed into rpm. */
const TO_RPM = { rpm: 1, rad_s: rpm(1), hz: 60 };
const NAMES = { rpm: 'rpm', rad_s: 'rad/s', hz: 'Hz' };

/** Words by which a header names a column; the first that fits counts. */
const COLUMNS = [
  ['speed', /speed|rpm|omega|ω|rotation|drehzahl|1\/min|min-1|min⁻¹/i],
  ['frequency', /freq|^f\b|\bhz\b/i],
  ['amplitude', /ampl|level|displ|deflection|rms|peak|auslenkung|weg/i],
];

/** The unit of a speed that a header names. */
function speedUnit(words) {
  if (/rad/i.test(words)) return 'rad_s';
  if (/rpm|1\/min|min-1|min⁻¹|u\/min/i.test(words)) return 'rpm';
  return /hz|1\/s/i.test(words) ? 'hz' : null;
}

/** The unit of a length that a header names: what is in brackets, whatever it is, or a unit as its last word. */
function lengthUnit(words) {
  const bracketed = /[[(]\s*(?:in\s+)?([^\])]*?)\s*[\])]/i.exec(words)?.[1];
  if (bracketed) return bracketed;
  const last = words.trim().split(/[\s_,]+/).at(-1);
  return lengthIn(last, 'm') === null ? null : last;
}

/** Cells of a line, which may be quoted. Where columns are parted by semicolons or tabs, a comma is a decimal one. */
function cellsOf(line) {
  const parting = line.includes(';') ? ';' : line.includes('\t') ? '\t' : ',';
  const cells = line.match(new RegExp(`(?:^|${parting})(?:\\s*"[^"]*"|[^${parting}]*)`, 'g'))
    .map((cell, k) => (k > 0 || cell.startsWith(parting) ? cell.slice(1) : cell).trim().replace(/^"|"$/g, ''));
  return parting === ',' ? cells : cells.map((cell) => cell.replace(',', '.'));
}

/** Which column is what by a header, as indices; what nobody named is not there. */
function columnsOf(header) {
  const found = {};
  header.forEach((words, k) => {
    const name = COLUMNS.find(([, pattern]) => pattern.test(words))?.[0];
    if (name && !(name in found)) found[name] = k;
  });
  return found;
}

/**
 * Points of a table. Columns are found by its header; without one they are speed, frequency in Hz and amplitude. An empty cell is nothing.
 * @param {string} text
 * @param {string} unit of the speeds; empty: what the header names, or rpm
 * @param {string} length unit of amplitudes in the diagram
 * @returns {{points: {rpm: number, hz: number | null, amplitude: number | null}[], bad: string[], words: string}}
 */
export function measurement(text, unit, length) {
  const lines = text.replace(/^\ufeff/, '').split(/\r\n|\n|\r/).map((line, k) => ({ line, k }))
    .filter(({ line }) => line.trim() !== '' && !line.startsWith('#'));
  const first = cellsOf(lines[0]?.line ?? '');
  const header = first.some((cell) => cell !== '' && Number.isNaN(Number(cell))) ? first : null;
  const at = header ? columnsOf(header) : { speed: 0, frequency: 1, amplitude: 2 };
  const failed = (words) => ({ points: [], bad: [], words });
  if (lines.length === 0) return failed('The file is empty.');
  if (at.speed === undefined || (at.frequency === undefined && at.amplitude === undefined)) {
    return failed(`Nothing is taken: the header “${header.join(', ').slice(0, 100)}” does not say which column is the speed and which the frequency or the amplitude. Name the columns like this: speed_rpm, frequency_Hz, amplitude_${length}.`);
  }
  const used = unit || (header && speedUnit(header[at.speed])) || 'rpm';
  const kilo = header && at.frequency !== undefined && /khz/i.test(header[at.frequency]) ? 1000 : 1;
  const own = header && at.amplitude !== undefined ? lengthUnit(header[at.amplitude]) : null;
  const factor = own ? lengthIn(own, length) : 1;
  const points = [];
  const bad = [];
  for (const { line, k } of header ? lines.slice(1) : lines) {
    const cells = cellsOf(line);
    const value = (column) => (column === undefined || cells[column] === undefined || cells[column] === '' ? null : Number(cells[column]));
    const [omega, hz, amplitude] = [value(at.speed), value(at.frequency), value(at.amplitude)];
    if (omega === null || [omega, hz, amplitude].some((each) => each !== null && !Number.isFinite(each))) {
      bad.push(`line ${k + 1}: expected numbers for speed, frequency and amplitude, not “${line.slice(0, 60)}”`);
    } else if (omega < 0 || (hz ?? 0) < 0) {
      bad.push(`line ${k + 1}: speed and frequency must not be negative`);
    } else {
      points.push({ rpm: omega * TO_RPM[used], hz: hz === null ? null : kilo * hz, amplitude: amplitude === null || factor === null ? null : factor * amplitude });
    }
  }
  return { points, bad: bad.slice(0, 20), words: said({ points, bad, header, at, used, own, factor, length }) };
}

/** What was taken for what. */
function said({ points, bad, header, at, used, own, factor, length }) {
  const column = (name) => (header ? `“${header[at[name]]}”` : `column ${at[name] + 1}`);
  const taken = [`speed from ${column('speed')} in ${NAMES[used]}`];
  if (at.frequency !== undefined) taken.push(`frequency from ${column('frequency')}`);
  if (at.amplitude !== undefined) {
    taken.push(factor === null ? `no amplitude: ${own} cannot be converted to ${length}` : `amplitude from ${column('amplitude')} ${own ? `in ${own}` : `assumed to be in ${length}`}`);
    if (header && /rms/i.test(header[at.amplitude])) taken.push('an rms value, beside curves of half peak to peak');
  }
  const speeds = points.map((point) => point.rpm);
  const range = points.length > 0 ? `, ${Math.round(Math.min(...speeds))} to ${Math.round(Math.max(...speeds))} rpm` : '';
  const left = bad.length > 0 ? ` ${bad.length} ${bad.length === 1 ? 'line is' : 'lines are'} left out.` : '';
  return `${points.length} measured ${points.length === 1 ? 'point' : 'points'}${range}: ${taken.join('; ')}.${left}`;
}

/** A Campbell diagram with measured frequencies over it. */
export function overCampbell(figure, measured) {
  const points = (measured ?? []).filter((point) => point.hz !== null);
  if (points.length === 0) return figure;
  const trace = {
    type: 'scatter', mode: 'markers', name: 'measured', x: points.map((point) => point.rpm), y: points.map((point) => point.hz),
    marker: { symbol: 'x', size: 9, color: '#d55e00' }, hovertemplate: '%{x:.0f} rpm, %{y:.1f} Hz<extra>measured</extra>',
  };
  return { data: [...figure.data, trace], layout: { ...figure.layout, showlegend: true } };
}
