// Uploads, with their progress: fetch cannot tell how much was sent.

import { address, headers, Refusal, Away } from './api.js';
import { isAway } from './away.js';
import { signOut } from './session.js';

/**
 * Uploads a package, or a mesh with what the service is to make of it.
 * @param {File} file
 * @param {{name?: string, settings: any} | null} mesh name and settings of the model of a mesh; nothing of a package, which has them inside
 * @param {(sent: number, all: number) => void} progress
 * @param {AbortSignal} signal
 * @returns {Promise<{model: any, known: boolean}>} the model, and whether the service had it already
 */
export function upload(file, mesh, progress, signal) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const type = mesh ? 'application/octet-stream' : 'application/zip';
    request.open('POST', address('/v1/models', mesh ? { name: mesh.name, settings: JSON.stringify(mesh.settings) } : {}));
    for (const [name, value] of Object.entries(headers({ 'Content-Type': type, Accept: 'application/json' }))) {
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
