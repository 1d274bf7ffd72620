// What was measured: a table of speed, frequency and amplitude.

/** What turns a unit of speed into rpm. */
const TO_RPM = { rpm: 1, rad_s: 60 / (2 * Math.PI), hz: 60 };

/** The unit that a header's words name. */
function unitOf(words) {
  if (/rad/i.test(words)) return 'rad_s';
  if (/hz|1\/s/i.test(words)) return 'hz';
  return 'rpm';
}

/** Cells of a line. Where columns are parted by semicolons or tabs, a comma is a decimal one. */
function cellsOf(line) {
  const parting = line.includes(';') ? ';' : line.includes('\t') ? '\t' : ',';
  const cells = line.split(parting).map((cell) => cell.trim().replace(/^"|"$/g, ''));
  return parting === ',' ? cells : cells.map((cell) => cell.replace(',', '.'));
}

/**
 * Points of a table with or without a header: speed, frequency in Hz, amplitude; an empty cell is nothing.
 * @param {string} text
 * @param {string} unit of the speeds; empty: what the header names, or rpm
 * @returns {{points: {rpm: number, hz: number | null, amplitude: number | null}[], bad: string[], words: string}}
 */
export function measurement(text, unit) {
  const lines = text.replace(/^\ufeff/, '').split(/\r\n|\n|\r/);
  const points = [];
  const bad = [];
  let used = unit || 'rpm';
  let begun = false;
  lines.forEach((line, k) => {
    if (line.trim() === '' || line.startsWith('#')) return;
    const cells = cellsOf(line);
    const value = (cell) => (cell === undefined || cell === '' ? null : Number(cell));
    const [omega, hz, amplitude] = cells.slice(0, 3).map(value);
    if (!begun && Number.isNaN(omega)) {
      if (!unit) used = unitOf(cells[0]);
      begun = true;
      return;
    }
    begun = true;
    if (omega === null || [omega, hz, amplitude].some((each) => each !== null && each !== undefined && !Number.isFinite(each))) {
      bad.push(`line ${k + 1}: expected numbers for speed, frequency and amplitude, not “${line.slice(0, 60)}”`);
    } else if (omega < 0 || (hz ?? 0) < 0) {
      bad.push(`line ${k + 1}: speed and frequency are not negative`);
    } else {
      points.push({ rpm: omega * TO_RPM[used], hz: hz ?? null, amplitude: amplitude ?? null });
    }
  });
  const shown = { rpm: 'rpm', rad_s: 'rad/s', hz: 'Hz' }[used];
  const words = `${points.length} measured ${points.length === 1 ? 'point' : 'points'}, speeds in ${shown}${bad.length > 0 ? `; ${bad.length} lines are left out` : ''}.`;
  return { points, bad: bad.slice(0, 20), words };
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
