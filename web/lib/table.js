// Tables that can be sorted.

import { h, replace } from './dom.js';

/**
 * A table of rows.
 * @param {{caption: string, columns: {name: string, title?: string, cell: (row: any) => any, sort?: (row: any) => any, number?: boolean}[],
 *   rows: any[], onChoose?: (row: any) => void}} what
 */
export function table({ caption, columns, rows, onChoose }) {
  let sorted = rows;
  let by = null;
  let down = false;
  const body = h('tbody');
  const heads = columns.map((column) => {
    const cell = h('th', { scope: 'col', class: column.number ? 'number' : null, title: column.title });
    if (column.sort) {
      cell.append(h('button', { type: 'button', on: { click: () => sort(column) } }, column.name));
    } else {
      cell.append(column.name);
    }
    return cell;
  });

  function sort(column) {
    down = by === column ? !down : false;
    by = column;
    const key = column.sort;
    sorted = [...rows].sort((a, b) => {
      const [x, y] = [key(a), key(b)];
      // What has no value comes last either way.
      if (x === y) return 0;
      if (x === null || x === undefined) return 1;
      if (y === null || y === undefined) return -1;
      return (x < y ? -1 : 1) * (down ? -1 : 1);
    });
    columns.forEach((each, index) => {
      if (each === by) heads[index].setAttribute('aria-sort', down ? 'descending' : 'ascending');
      else heads[index].removeAttribute('aria-sort');
    });
    fill();
  }

  function fill() {
    replace(body, sorted.map((row) => {
      const cells = columns.map((column, index) => {
        let content = column.cell(row);
        if (index === 0 && onChoose) {
          content = h('button', { type: 'button', on: { click: () => onChoose(row) } }, content);
        }
        return h('td', { class: column.number ? 'number' : null }, content);
      });
      return h('tr', {}, cells);
    }));
  }
  fill();
  // A table that is wider than the window is scrolled, by the keyboard too.
  return h('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption },
    h('table', {}, h('caption', { class: 'visually-hidden' }, caption), h('thead', {}, h('tr', {}, heads)), body));
}
