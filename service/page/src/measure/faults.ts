// What a problem of a fit says of its pictures.
import type { Problem } from "../api/types";
import type { PlaceName } from "./places";

export const NOT_INSTALLED = "detector-not-installed";

/** Of each picture by its place what is wrong with it; `rest` is of the fit as a whole, null if nothing is. */
export interface Faults {
  readonly views: ReadonlyMap<number, Problem>;
  readonly rest: Problem | null;
}

export interface FaultsOfPlaces {
  readonly places: ReadonlyMap<PlaceName, Problem>;
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

/** The same by the places of this screen, whose views a fit has in this order; null for one that has no place here. */
export function faultsOfPlaces(problem: Problem, order: readonly (PlaceName | null)[]): FaultsOfPlaces {
  const { views, rest } = faultsOf(problem);
  const places = new Map<PlaceName, Problem>();
  for (const [number, fault] of views) {
    const name = order[number];
    if (name) places.set(name, fault);
  }
  return { places, rest };
}

/** The view that a message begins with, as those about one of them do; null where it begins otherwise. */
export function viewNamedFirst(message: string): number | null {
  const found = /^views\.(\d+)\b/.exec(message);
  return found ? Number(found[1]) : null;
}

/**
 * A message of the service with its views as people call them: `views.1` is the side picture. It stays English whatever
 * the page speaks, as the rest of the message does.
 */
export function withViews(message: string, views: readonly { readonly view: string | null }[]): string {
  return message
    .replace(/(\. )?\bviews\.(\d+)\b/g, (whole, end: string | undefined, number: string, at: number) => {
      const view = views[Number(number)]?.view;
      if (!view) return whole;
      return `${end ?? ""}${at === 0 || end ? "The" : "the"} ${view} picture`;
    })
    .replaceAll("_", " ");
}

/** Whether a picture can never be measured, rather than not just now, or not as it lies with the service. */
export function isUnusable(problem: Problem): boolean {
  return problem.status === 422 && !codesOf(problem).includes(UNKNOWN_IMAGE);
}

/** It may have been erased meanwhile: the next attempt sends it anew. */
export function isErased(problem: Problem): boolean {
  return codesOf(problem).includes(UNKNOWN_IMAGE);
}

const UNKNOWN_IMAGE = "unknown-image";

function codesOf({ code, errors }: Problem): readonly string[] {
  return [code, ...(errors ?? []).map((error) => error.code)];
}

function viewOf(field: string | null | undefined): number | null {
  const found = /^views\.(\d+)(\.|$)/.exec(field ?? "");
  return found ? Number(found[1]) : null;
}

function withoutView(field: string): string {
  return field.replace(/^views\.\d+\.?/, "") || "image";
}
