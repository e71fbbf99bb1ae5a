// What a problem of a scan says of its pictures.
import type { Problem } from "../api/types";

export const NOT_INSTALLED = "detector-not-installed";

/** Of each picture by its place what is wrong with it; `rest` is of the scan as a whole, null if nothing is. */
export interface Faults {
  readonly views: ReadonlyMap<number, Problem>;
  readonly rest: Problem | null;
}

export function faultsOf(problem: Problem): Faults {
  const errors = problem.errors ?? [];
  const own = viewOf(problem.field);
  if (errors.length === 0) return own === null ? { views: new Map(), rest: problem } : { views: new Map([[own, problem]]), rest: null };
  const views = new Map<number, Problem>();
  for (const error of errors) {
    const number = viewOf(error.field);
    if (number === null) continue;
    const before = views.get(number)?.errors ?? [];
    views.set(number, { ...problem, errors: [...before, { ...error, field: withoutView(error.field) }] });
  }
  const others = errors.filter((error) => viewOf(error.field) === null);
  return { views, rest: others.length > 0 ? { ...problem, errors: others } : null };
}

function viewOf(field: string | null | undefined): number | null {
  const found = /^views\.(\d+)(\.|$)/.exec(field ?? "");
  return found ? Number(found[1]) : null;
}

function withoutView(field: string): string {
  return field.replace(/^views\.\d+\.?/, "") || "picture";
}
