// What was found about a model's stiffness at speed.

import { h } from '../../lib/dom.js';

/** What the verdict on K(Ω) means for results, by its word. */
const STIFFENING = {
  sound: 'The stiffness at speed is consistent: it can be interpolated between the given speeds.',
  suspect: 'The stiffness at speed is doubtful: between the given speeds, frequencies and amplitudes are off.',
  unsound: 'The stiffness at speed is not to be relied on, nor are frequencies, critical speeds and amplitudes that are computed with it.',
  absent: 'The model has its stiffness at rest only: results are without stiffening by rotation.',
};

/** The finding about K(Ω): first what it means, then the figures behind it, closed where all is well; `indefinite` where the full model found speeds at which K(Ω) is none. */
export function stiffeningNote({ verdict, message }, indefinite = false) {
  const isFine = verdict === 'sound' && !indefinite;
  return h('div', { class: `note ${isFine ? 'fine' : 'warning'}` },
    h('strong', {}, STIFFENING[verdict] ?? verdict, indefinite ? ' At some speeds K(Ω) is not positive definite.' : null),
    verdict === 'absent' ? null : h('details', { class: 'rare', open: !isFine }, h('summary', {}, 'The figures behind it'), h('p', { class: 'small' }, message)));
}
