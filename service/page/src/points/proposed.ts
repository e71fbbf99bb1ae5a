// Points as the service proposes them, and who they may belong to.
import type { PointsProposal } from "../api/types";
import { isPointName } from "./catalogue";
import { namedPoints } from "./named";
import { NO_POINTS, isEnough, skipRest } from "./placed";
import type { Points } from "./placed";

/** Left, top, right and bottom, in pixels of the picture. */
export type Box = PointsProposal["persons"][number];

/** What was not proposed is asked for only where a body cannot do without. */
export function proposedPoints({ points, person, doubtful }: PointsProposal): Points {
  const placed = namedPoints(points);
  const proposed: Points = {
    ...NO_POINTS,
    placed,
    person,
    doubts: doubtful.filter((name) => isPointName(name) && placed[name] !== undefined),
  };
  return isEnough(proposed) ? skipRest(proposed) : proposed;
}

export function countProposed({ placed }: Points): number {
  return Object.values(placed).filter((where) => where.proposed).length;
}

export function hasProposed(points: Points): boolean {
  return countProposed(points) > 0;
}

/** There are some, and nobody has clicked, moved or confirmed any of them. */
export function isAllProposed(points: Points): boolean {
  const count = countProposed(points);
  return count > 0 && count === Object.keys(points.placed).length;
}

/** The place of the person who is tapped on, among boxes that may overlap; null for none. */
export function personAt(boxes: readonly Box[], x: number, y: number): number | null {
  let best: number | null = null;
  let least = 1;
  boxes.forEach(([left, top, right, bottom], i) => {
    // One at the border: who is tapped nearer to their middle is meant.
    const off = Math.max(
      Math.abs(2 * x - left - right) / (right - left),
      Math.abs(2 * y - top - bottom) / (bottom - top),
    );
    if (off <= least) [best, least] = [i, off];
  });
  return best;
}
