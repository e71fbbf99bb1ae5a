// What the views of several pictures are called.
import type { FittedView } from "../api/fits";
import type { ViewKind } from "../api/types";
import { capitalised } from "../messages/figures";
import { messages } from "../messages";

export function viewLabel(view: ViewKind): string {
  return messages.measure.views[view].label;
}

/** Within a sentence, without its article. */
export function pictureOf(view: ViewKind): string {
  return messages.measure.views[view].picture;
}

/** As a heading, or before what is said of it. */
export function pictureTitle(view: ViewKind): string {
  return capitalised(pictureOf(view));
}

type Viewed = Pick<FittedView, "view">;

/** Labels by which each of several is told from the others. */
export function viewLabels(views: readonly Viewed[]): readonly string[] {
  return distinct(views, viewLabel);
}

/** The same as headings. */
export function viewTitles(views: readonly Viewed[]): readonly string[] {
  const { ofPicture } = messages.measure;
  return distinct(views, (view) => ofPicture(pictureOf(view)));
}

/** Those of the same view are numbered. */
function distinct(views: readonly Viewed[], name: (view: ViewKind) => string): readonly string[] {
  const { viewNumber } = messages.measure;
  return views.map(({ view }, number) => {
    const called = name(view ?? "other");
    const alike = views.filter((other) => other.view === view);
    return alike.length === 1 ? called : viewNumber(called, views.slice(0, number + 1).filter((other) => other.view === view).length);
  });
}
