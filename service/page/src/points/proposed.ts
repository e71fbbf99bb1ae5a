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

/** So near its border, as a share of the picture's side, a person is cut off; and so small beside another, somebody behind. */
const BORDER = 0.01;
const LEAST_SHARE = 0.5;

/** Somebody wholly in the picture, where the one proposed is cut off at its border; null where there is nobody better. */
export function wholePerson({ person, persons, image_size: { width, height } }: Pick<PointsProposal, "person" | "persons" | "image_size">): number | null {
  const chosen = person === null ? undefined : persons[person];
  const isCut = ([left, top, right, bottom]: Box) =>
    left < BORDER * width || top < BORDER * height || right > (1 - BORDER) * width || bottom > (1 - BORDER) * height;
  if (!chosen || !isCut(chosen)) return null;
  const found = persons.findIndex((box) => !isCut(box) && box[3] - box[1] > LEAST_SHARE * (chosen[3] - chosen[1]));
  return found < 0 ? null : found;
}

/** All of them in one box; null where there are none. */
export function around(boxes: readonly Box[]): Box | null {
  if (boxes.length === 0) return null;
  const most = (side: 0 | 1 | 2 | 3, pick: (...values: number[]) => number) => pick(...boxes.map((box) => box[side]));
  return [most(0, Math.min), most(1, Math.min), most(2, Math.max), most(3, Math.max)];
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
