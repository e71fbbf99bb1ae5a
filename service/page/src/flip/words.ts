// Limbs that were turned, as they are told.
import type { Facing } from "../api/types";
import { capitalised, listed } from "../messages/figures";
import { messages } from "../messages/language";
import type { Flips, TurnedLimb } from "./flips";

/** Within a sentence. */
export function inWords(flips: Flips): string {
  const { limbs: words, points } = messages.value;
  return listed(Object.entries(flips).map(([limb, facing]) => words.turned[facing](points.limbs[limb as TurnedLimb])));
}

/** Of the limb under the pointer: which way it points, and what a click does. */
export function hoverWords(limb: TurnedLimb, found: Facing, flips: Flips): string {
  const { limbs: words, points } = messages.value;
  const say = flips[limb] ? words.hoverBack : words.hover;
  return say(capitalised(points.limbs[limb]), words.facings[flips[limb] ?? found]);
}
