// A new job of any kind: from a model, or as an earlier job, but ….

import { api } from '../lib/api.js';
import { h, replace } from '../lib/dom.js';
import { KINDS, nameOf } from '../lib/format.js';
import { inWords } from '../lib/form/named.js';
import { placeWith } from '../lib/place.js';
import { select } from './job/choices.js';
import { campaignOfModel } from './request/campaign.js';
import { fromSweep } from './request/from-sweep.js';
import { mended } from './request/mend.js';
import { runUpsOfModel } from './request/run-up.js';
import { chooseModel, requestForm } from './request/view.js';
import { sceneOf, speedsOf } from './request/sensible.js';

/** Kinds of jobs that are asked for by a form. */
export const REQUESTS = {
  sweep: {
    words: 'Sweep: contact over a range of speeds', schema: 'SweepRequest', path: '/v1/sweeps', plan: '/v1/sweeps/plan', priced: true, judged: true,
    // Stress where there are elements to compute it in: whether a wheel bears its motion is asked of every one.
    begin: (model) => ({ model: model.id, speeds: speedsOf(model), scene: sceneOf(model), ...(model.mesh && { record: { stress: {} } }) }),
  },
  modal_analysis: {
    words: 'Modal analysis: frequencies over speed', schema: 'ModalAnalysisRequest', path: '/v1/modal-analyses', plan: '/v1/modal-analyses/plan', priced: false,
    begin: (model) => ({ model: model.id, speeds: { ...speedsOf(model, 25), from: 0 }, lobes: 2 }),
  },
  study: {
    words: 'Study: what accuracy costs', schema: 'StudyRequest', path: '/v1/studies', plan: '/v1/studies/plan', priced: false,
    begin: (model) => {
      const { to } = speedsOf(model);
      return { model: model.id, speeds: { values: [Math.round(0.6 * to)], unit: 'rpm' }, scene: sceneOf(model) };
    },
  },
  case_study: {
    words: 'Case study: one speed in detail', schema: 'CaseStudyRequest', path: '/v1/case-studies', plan: '/v1/case-studies/plan', priced: false,
    begin: (model) => ({ model: model.id, speed: { value: Math.round(0.6 * speedsOf(model).to), unit: 'rpm' }, scene: sceneOf(model) }),
  },
  branches: {
    words: 'Branches: periodic responses followed', schema: 'BranchesRequest', path: '/v1/branches', plan: '/v1/branches/plan', priced: false,
    begin: (model) => {
      const { from, to } = speedsOf(model);
      return { model: model.id, speed: { value: Math.round(0.6 * to), unit: 'rpm' }, along: { parameter: 'speed', from, to }, scene: sceneOf(model) };
    },
  },
  run_up: {
    words: 'Run-up or run-down: a speed that changes', schema: 'RunUpRequest', path: '/v1/run-ups', plan: '/v1/run-ups/plan', priced: false,
    begin: runUpsOfModel,
  },
  campaign: {
    words: 'Campaign: many designs of a scene', schema: 'CampaignRequest', path: '/v1/campaigns', plan: '/v1/campaigns/plan', priced: false,
    begin: campaignOfModel,
  },
};

export async function show(main, { query }, signal, first = 'sweep') {
  const place = h('div');
  if (query.has('as')) {
    const job = await api.get(`/v1/jobs/${query.get('as')}`, { signal });
    const kind = REQUESTS[job.kind];
    if (!kind) throw new Error(`a job of kind ${job.kind} has no form`);
    if (!job.posted) throw new Error('an earlier version did not keep the request of this job: begin a new one');
    if (job.posted_to !== kind.path) throw new Error('this job records a sweep, and has no request of its own: begin with that sweep');
    replace(main, h('h1', {}, `As ${nameOf(job)}, but …`), place);
    const model = await api.get(`/v1/models/${job.model}`, { signal });
    const mend = query.get('mend');
    const value = mend ? mended(job.posted, mend, model) : job.posted;
    const words = `Model: ${model.name}${mend ? `. Changed against that job: ${inWords(`\`${mend}\``)}.` : ''}`;
    await requestForm(place, { model, kind, value, words }, signal);
    return;
  }
  const name = query.get('kind') ?? first;
  const kind = REQUESTS[name] ?? REQUESTS.sweep;
  const go = (changes) => { location.hash = placeWith(first, query, changes); };
  replace(main, h('h1', {}, `New ${KINDS[name in REQUESTS ? name : 'sweep'].toLowerCase()}`),
    h('div', { class: 'row' }, select('Kind of job', Object.entries(REQUESTS).map(([key, one]) => [key, one.words]), name, (chosen) => go({ kind: chosen }))),
    place);
  if (!query.has('model')) {
    await chooseModel(place, (model) => go({ model }), signal);
    return;
  }
  const model = await api.get(`/v1/models/${query.get('model')}`, { signal });
  if (query.has('of')) {
    const sweep = await api.get(`/v1/jobs/${query.get('of')}`, { signal });
    const value = fromSweep(name, kind.begin(model), sweep, Number(query.get('at')));
    const said = `Model: ${model.name}. Scene and speed are those of ${nameOf(sweep)}; change them as needed. Lengths are in ${model.units.length}.`;
    await requestForm(place, { model, kind, value, words: said }, signal);
    return;
  }
  const words = `Model: ${model.name}. Speeds and casing begin with what suits its size: change them to those of your machine.`;
  await requestForm(place, { model, kind, value: kind.begin(model), words }, signal);
}
