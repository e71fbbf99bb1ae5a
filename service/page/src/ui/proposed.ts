// Of how many points nobody said where they are: their names tell nobody anything.
import type { InitialPose } from "../api/types";
import { messages } from "../messages";

/** The assumption that names proposed points, one after the other. */
export const PROPOSED_POINTS = "points";

export interface Proposed {
  readonly count: number;
  /** Whether nobody clicked any; false while the request is not known. */
  readonly isAll: boolean;
}

/** Null where somebody clicked every point. `asked` are the points of the request, null while they are not known. */
export function proposedOf(assumptions: InitialPose["assumptions"], asked: unknown): Proposed | null {
  const names = namesOfProposed(assumptions);
  if (names.length === 0) return null;
  // A proposal that was sent back is among the proposed points, and no click.
  const isAll = typeof asked === "object" && asked !== null && Object.keys(asked).every((name) => names.includes(name));
  return { count: names.length, isAll };
}

export function namesOfProposed(assumptions: InitialPose["assumptions"]): readonly string[] {
  const named = assumptions.find(({ quantity }) => quantity === PROPOSED_POINTS)?.value;
  return typeof named === "string" ? named.split(", ") : [];
}

export function proposedText({ count, isAll }: Proposed): string {
  const { assumed } = messages.frame;
  return isAll ? assumed.allPoints : assumed.points(count);
}
