// A value with its past and future: undo and redo.

export interface Timeline<T> {
  readonly past: readonly T[];
  readonly present: T;
  readonly future: readonly T[];
}

const DEPTH = 200;

export function begin<T>(present: T): Timeline<T> {
  return { past: [], present, future: [] };
}

export function advance<T>(line: Timeline<T>, present: T): Timeline<T> {
  if (present === line.present) return line;
  return { past: [...line.past, line.present].slice(-DEPTH), present, future: [] };
}

/** Change the present without leaving a step behind: what a drag does between its ends. */
export function amend<T>(line: Timeline<T>, present: T): Timeline<T> {
  return { ...line, present };
}

export function undo<T>(line: Timeline<T>): Timeline<T> {
  const present = line.past.at(-1);
  if (present === undefined) return line;
  return { past: line.past.slice(0, -1), present, future: [line.present, ...line.future] };
}

export function redo<T>(line: Timeline<T>): Timeline<T> {
  const [present, ...future] = line.future;
  if (present === undefined) return line;
  return { past: [...line.past, line.present], present, future };
}
