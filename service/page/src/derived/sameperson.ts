// Whether two fits may be of one person.
import type { FitOptions } from "../api/types";

const SAME_HEIGHT_M = 0.0005;

type Known = Pick<FitOptions, "gender" | "height_m">;

/** Fits are combined only where gender and height are the same; further differences the service tells. */
export function toldAlike(one: Known, other: Known): boolean {
  if (one.gender !== other.gender) return false;
  const [height, another] = [one.height_m ?? null, other.height_m ?? null];
  if (height === null || another === null) return height === another;
  return Math.abs(height - another) <= SAME_HEIGHT_M;
}
