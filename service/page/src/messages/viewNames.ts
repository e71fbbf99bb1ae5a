// What pictures are called by from where they show the person.
import type { ViewKind } from "../api/types";
import { messages } from ".";

interface Viewed {
  readonly view: ViewKind | null;
}

/** Labels by which each of several is told from the others. */
export function viewLabels(views: readonly Viewed[]): readonly string[] {
  return distinct(views, (view) => messages.measure.views[view].label);
}

/** The same as headings, or before what is said of a picture. */
export function viewTitles(views: readonly Viewed[]): readonly string[] {
  return distinct(views, (view) => messages.measure.views[view].title);
}

/** Those of the same view are numbered. */
function distinct(views: readonly Viewed[], name: (view: ViewKind) => string): readonly string[] {
  return views.map(({ view }, number) => {
    const called = name(view ?? "other");
    const alike = views.filter((other) => other.view === view);
    return alike.length === 1 ? called : `${called} ${views.slice(0, number + 1).filter((other) => other.view === view).length}`;
  });
}
