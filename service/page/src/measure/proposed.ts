// Of how many points of several pictures nobody said where they are.
import type { Asked, FittedView } from "../api/fits";
import { messages } from "../messages";
import { proposedOf } from "../ui/proposed";
import { pictureOf } from "./views";

type Viewed = Pick<FittedView, "number" | "view" | "assumptions">;

/** Null where somebody clicked every point. */
export function proposedText(views: readonly Viewed[], asked: Pick<Asked, "views">): string | null {
  const { frame, measure } = messages;
  const counts = views.map(({ number, view, assumptions }) => ({ view, proposed: proposedOf(assumptions, asked.views[number]?.points ?? {}) }));
  const told = counts.flatMap(({ view, proposed }) => {
    if (!proposed) return [];
    const { all, some } = measure.proposed;
    return [proposed.isAll ? all(pictureOf(view ?? "other")) : some(proposed.count, pictureOf(view ?? "other"))];
  });
  if (told.length === 0) return null;
  return counts.every(({ proposed }) => proposed?.isAll) ? frame.assumed.allPoints : frame.assumed.pointsOf(told);
}
