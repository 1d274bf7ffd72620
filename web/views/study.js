// A new study: the form of new jobs, beginning with that kind.

import { show as showRequest } from './new-job.js';

export function show(main, where, signal) {
  return showRequest(main, where, signal, 'study');
}
