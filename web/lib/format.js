// Numbers and times as people read them.

const RPM = 60 / (2 * Math.PI);

/** A number of so many significant digits, with separators between thousands. */
export function number(value, digits = 4) {
  if (value === null || value === undefined) return '–';
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e7)) return value.toExponential(Math.max(0, digits - 1)).replace('e+', 'e');
  return value.toLocaleString('en', { maximumSignificantDigits: Math.max(digits, Math.ceil(Math.log10(size + 1))) });
}

/** Turns rad/s into revolutions per minute. */
export function rpm(rad_s) {
  return rad_s * RPM;
}

/** A speed of rotation: `12,000 rpm`. */
export function speed(rad_s) {
  return `${number(Math.round(10 * rpm(rad_s)) / 10, 5)} rpm`;
}

/** A speed with both units. */
export function speedLong(rad_s) {
  return `${speed(rad_s)} (${number(rad_s, 5)} rad/s)`;
}

/** By how much a speed changes in a second: `104.7 rad/s² (1,000 rpm/s)`. */
export function rate(rad_s2) {
  return `${number(rad_s2)} rad/s² (${number(rpm(rad_s2))} rpm/s)`;
}

/** A value with how far off it may be, to two digits of that: `23,456.78 ± 0.21`. */
export function known(value, error) {
  if (!Number.isFinite(value) || !(error > 0)) return number(value, 6);
  const decimals = Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(error))));
  const digits = { minimumFractionDigits: decimals, maximumFractionDigits: decimals };
  return `${value.toLocaleString('en', digits)} ± ${error.toLocaleString('en', digits)}`;
}

/** A duration: `1.2 s`, `4 min`, `3.5 h`. */
export function duration(seconds) {
  if (seconds === null || seconds === undefined) return '–';
  if (seconds < 1) return `${number(1e3 * seconds, 2)} ms`;
  if (seconds < 90) return `${number(seconds, 2)} s`;
  if (seconds < 90 * 60) return `${number(seconds / 60, 2)} min`;
  if (seconds < 48 * 3600) return `${number(seconds / 3600, 2)} h`;
  return `${number(seconds / 86_400, 2)} days`;
}

/** A size: `12 MB`. */
export function bytes(size) {
  if (size === null || size === undefined) return '–';
  const units = ['bytes', 'kB', 'MB', 'GB', 'TB'];
  let unit = 0;
  let rest = size;
  while (rest >= 999.5 && unit < units.length - 1) {
    rest /= 1000;
    unit += 1;
  }
  return `${number(rest, 3)} ${units[unit]}`;
}

/** A share: `12 %`. */
export function percent(fraction, digits = 2) {
  return fraction === null || fraction === undefined ? '–' : `${number(100 * fraction, digits)} %`;
}

/** A moment, in the reader's time zone. */
export function moment(text) {
  return text ? new Date(text).toLocaleString('en-GB', { dateStyle: 'medium', timeStyle: 'short' }) : '–';
}

/** `1 speed`, `3 speeds`. */
export function count(n, one, many = `${one}s`) {
  return `${n.toLocaleString('en')} ${n === 1 ? one : many}`;
}

/** First characters of a model's id, which is long. */
export function short(id) {
  return id.slice(0, 12);
}

export const KINDS = {
  sweep: 'Sweep',
  modal_analysis: 'Modal analysis',
  model_generation: 'Model generation',
  study: 'Study',
  case_study: 'Case study',
  branches: 'Branches',
  run_up: 'Run-up or run-down',
  campaign: 'Campaign',
};

/** What a job is called: its name, or its kind, when it was posted, and the end of its id. */
export function nameOf(job) {
  return job.name || `${KINDS[job.kind] ?? job.kind}, ${moment(job.created_at)} (…${job.id.slice(-4)})`;
}
