// The pictures of an orbit: a grid of directions around the content, columns around the up axis, rows by elevation.

export interface Orbit {
  columns: number;
  /** Elevation of each row, degrees, growing. */
  rows: number[];
  /** The row that is shown first, from column 0; its picture there is the document's own. */
  start: number;
  width: number;
  height: number;
  type: string;
  /** base64, row by row; "" for the first picture. */
  pictures: string[];
}

/** Where somebody looks from: whole numbers are pictures, what lies between is rounded. */
export interface Place {
  column: number;
  row: number;
}

const wrapped = (value: number, count: number) => ((value % count) + count) % count;

export function clamped(place: Place, orbit: Orbit): Place {
  return { column: wrapped(place.column, orbit.columns), row: Math.max(0, Math.min(orbit.rows.length - 1, place.row)) };
}

export function indexOf(place: Place, orbit: Orbit): number {
  const { column, row } = clamped(place, orbit);
  return Math.round(row) * orbit.columns + (Math.round(column) % orbit.columns);
}

/** Pictures that are likely to be next, the nearest first. */
export function around(place: Place, orbit: Orbit, reach: number): number[] {
  const found: number[] = [];
  for (let step = 1; step <= reach; ++step)
    for (const by of [step, -step]) {
      found.push(indexOf({ column: place.column + by, row: place.row }, orbit));
      if (step === 1) found.push(indexOf({ column: place.column, row: place.row + by }, orbit));
    }
  return [...new Set(found)];
}

/** Degrees between rows; 0 where there is one. */
export function rowStep(orbit: Orbit): number {
  const [first, second] = orbit.rows;
  return first === undefined || second === undefined ? 0 : second - first;
}
