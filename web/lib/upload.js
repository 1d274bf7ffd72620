// Uploads, with their progress: fetch cannot tell how much was sent.

import { headers, Refusal, Away } from './api.js';
import { isAway } from './away.js';
import { signOut } from './session.js';

/**
 * Uploads a package.
 * @param {File} file
 * @param {(sent: number, all: number) => void} progress
 * @param {AbortSignal} signal
 * @returns {Promise<{model: any, known: boolean}>} the model, and whether the service had it already
 */
export function upload(file, progress, signal) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', '/v1/models');
    for (const [name, value] of Object.entries(headers({ 'Content-Type': 'application/zip', Accept: 'application/json' }))) {
      request.setRequestHeader(name, value);
    }
    request.upload.addEventListener('progress', (event) => progress(event.loaded, event.total));
    request.addEventListener('load', () => {
      let answer = {};
      try {
        answer = JSON.parse(request.responseText);
      } catch {
        answer = { title: `The service answered ${request.status}` };
      }
      if (request.status < 300) resolve({ model: answer, known: request.status === 200 });
      else {
        if (request.status === 401) signOut();
        reject(new Refusal(request.status, answer));
      }
    });
    // A service that refuses a body before it has come may close the connection.
    request.addEventListener('error', () => {
      isAway();
      reject(new Away('the upload was interrupted'));
    });
    request.addEventListener('abort', () => reject(signal.reason));
    signal.addEventListener('abort', () => request.abort());
    request.send(file);
  });
}
