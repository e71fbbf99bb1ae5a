// Limbs that were turned, as they are told.
import type { Facing, ViewResult } from "../api/types";
import { capitalised, listed } from "../messages/figures";
import { messages } from "../messages";
import { viewTitles } from "../messages/viewNames";
import { isEmpty } from "./flips";
import type { Flips, FlipsOfViews, TurnedLimb } from "./flips";

/** Within a sentence; of several pictures each with its name. */
export function inWords(flips: FlipsOfViews, views: readonly Pick<ViewResult, "view">[]): string {
  const titles = viewTitles(views);
  const told = views.flatMap((_, number) => {
    const own = flips[number];
    if (!own || isEmpty(own)) return [];
    return [views.length > 1 ? messages.frame.ofField(titles[number]!, inWordsOfOne(own)) : inWordsOfOne(own)];
  });
  return told.join("; ");
}

function inWordsOfOne(flips: Flips): string {
  const { limbs: words, points } = messages;
  return listed(Object.entries(flips).map(([limb, facing]) => words.turned[facing](points.limbs[limb as TurnedLimb])));
}

/** Of the limb under the pointer: which way it points, and what a click does. */
export function hoverWords(limb: TurnedLimb, found: Facing, flips: Flips): string {
  const { limbs: words, points } = messages;
  const say = flips[limb] ? words.hoverBack : words.hover;
  return say(capitalised(points.limbs[limb]), words.facings[flips[limb] ?? found]);
}
