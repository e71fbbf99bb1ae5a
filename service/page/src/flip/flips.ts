// Which limbs are turned the other way, as it is seen before it is fitted.
import type { Facing, Limb, ViewResult } from "../api/types";

/** Upper before lower, as they hang together. */
export const CHAINS = [
  ["left_upper_arm", "left_forearm"],
  ["right_upper_arm", "right_forearm"],
  ["left_thigh", "left_shin"],
  ["right_thigh", "right_shin"],
] as const;

/** All that can be turned: which way the trunk leans is not a limb's matter. */
export type TurnedLimb = (typeof CHAINS)[number][number];

export const TURNED_LIMBS: readonly TurnedLimb[] = CHAINS.flat();

/** Where each limb that was turned is to point. */
export type Flips = Readonly<Partial<Record<TurnedLimb, Facing>>>;

export const NO_FLIPS: Flips = {};

/** The same of each picture by its number. */
export type FlipsOfViews = Readonly<Record<number, Flips>>;

export function isTurnedLimb(limb: string): limb is TurnedLimb {
  return (TURNED_LIMBS as readonly string[]).includes(limb);
}

export function isEmpty(flips: Flips): boolean {
  return Object.keys(flips).length === 0;
}

export function areAllEmpty(flips: FlipsOfViews): boolean {
  return Object.values(flips).every(isEmpty);
}

/** Which way each limb points in a picture, by the fit. */
export function facingsOf({ limb_facing }: Pick<ViewResult, "limb_facing">): Readonly<Partial<Record<Limb, Facing>>> {
  return Object.fromEntries(limb_facing.map(({ limb, facing }) => [limb, facing]));
}

export function opposite(facing: Facing): Facing {
  return facing === "toward" ? "away" : "toward";
}

/** Turn a limb the other way; a second time turns it back. */
export function flipped(flips: Flips, limb: TurnedLimb, found: Facing): Flips {
  const { [limb]: turned, ...others } = flips;
  return turned === undefined ? { ...flips, [limb]: opposite(found) } : others;
}
