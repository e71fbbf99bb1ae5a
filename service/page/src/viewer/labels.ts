// Where labels of tapes stand: in two columns beside the body, none over another, each near its tape.
import type { TapeEnds } from "./Tapes";

export interface Placed {
  readonly name: string;
  readonly side: "left" | "right";
  /** Of the label's middle, pixels from the canvas' upper edge. */
  readonly y: number;
  /** Where its line ends, on the tape. */
  readonly at: readonly [number, number];
}

interface Room {
  readonly width: number;
  readonly height: number;
  /** From one label's middle to the next. */
  readonly step: number;
  /** So much of the right column, from the lower edge, something else covers. */
  readonly covered: number;
}

/** Tapes whose middle is nearer to the body's than this share of the width may be told on either side. */
const CENTRAL = 0.05;

export function placedLabels(ends: readonly TapeEnds[], { width, height, step, covered }: Room): Placed[] {
  if (ends.length === 0) return [];
  // The median: the measured arm and leg would draw a mean to their side.
  const middle = ends.map(({ left, right }) => (left[0] + right[0]) / 2).sort((a, b) => a - b)[ends.length >> 1]!;
  const sides = { left: [] as Placed[], right: [] as Placed[] };
  const add = (side: "left" | "right", { name, ...end }: TapeEnds) => sides[side].push({ name, side, y: end[side][1], at: end[side] });
  const aside = (each: TapeEnds) => (each.left[0] + each.right[0]) / 2 - middle;
  const isCentral = (each: TapeEnds) => Math.abs(aside(each)) < CENTRAL * width;
  for (const each of ends.filter((each) => !isCentral(each))) add(aside(each) < 0 ? "left" : "right", each);
  // The fuller column gets none while the other has room.
  const central = ends.filter(isCentral).sort((a, b) => a.left[1] - b.left[1]);
  for (const each of central) add(sides.left.length < sides.right.length ? "left" : "right", each);
  return [...apart(sides.left, height, step), ...apart(sides.right, height - covered, step)];
}

/** From the top down each at least a step below the one before, then from the bottom up where they ran out of the room. */
function apart(column: readonly Placed[], height: number, step: number): Placed[] {
  const sorted = [...column].sort((a, b) => a.y - b.y);
  let least = step / 2;
  const down = sorted.map((each) => {
    const y = Math.max(each.y, least);
    least = y + step;
    return { ...each, y };
  });
  let most = height - step / 2;
  return down
    .reverse()
    .map((each) => {
      const y = Math.min(each.y, most);
      most = y - step;
      return { ...each, y };
    })
    .reverse();
}
