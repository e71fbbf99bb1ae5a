// How far measurements err, from service/docs/accuracy_tables.md; a test compares the two.
import figures from "./figures.json";

/** Mean absolute errors: centimetres, and kilograms where the weight is not given. */
export interface Errors {
  readonly chest: number;
  readonly waist: number;
  readonly hip: number;
  readonly weight: number | null;
}

export const PEOPLE: number = figures.people;
/** Pictures as a phone takes them; the waist is the smallest. */
export const PAIR: Readonly<Record<keyof (typeof figures)["pair"], Errors>> = figures.pair;
/** One picture in any stance, clicked; the waist is at the navel. */
export const SINGLE: Readonly<Record<keyof (typeof figures)["single"], Errors>> = figures.single;
/** Of waists in loose clothes, centimetres. */
export const LOOSE_WAIST: number = figures.looseWaist;

/** From the least to the most of the girths' errors. */
export function girthErrors({ chest, waist, hip }: Errors): readonly [number, number] {
  return [Math.min(chest, waist, hip), Math.max(chest, waist, hip)];
}
