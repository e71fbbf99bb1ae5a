// Placed points as a value, and what can be done to it; every change gives a new value.
import { LIMITS } from "../api/limits";
import { LIMB_POINTS, POINT_NAMES, TRUNK_POINTS, mirrored } from "./catalogue";
import type { PointName } from "./catalogue";

export interface Place {
  readonly x: number;
  readonly y: number;
  /** Behind something else: its place is a guess. */
  readonly hidden: boolean;
}

export interface Points {
  readonly placed: Readonly<Partial<Record<PointName, Place>>>;
  readonly skipped: readonly PointName[];
  /** The point asked for out of turn, if any. */
  readonly asked: PointName | null;
}

export const NO_POINTS: Points = { placed: {}, skipped: [], asked: null };

/** The point to click next; null when all are placed or skipped. */
export function nextPoint(points: Points): PointName | null {
  if (points.asked !== null) return points.asked;
  return POINT_NAMES.find((name) => !points.placed[name] && !points.skipped.includes(name)) ?? null;
}

export function place(points: Points, name: PointName, x: number, y: number): Points {
  const hidden = points.placed[name]?.hidden ?? false;
  return {
    placed: { ...points.placed, [name]: { x, y, hidden } },
    skipped: points.skipped.filter((each) => each !== name),
    asked: points.asked === name ? null : points.asked,
  };
}

export function toggleHidden(points: Points, name: PointName): Points {
  const old = points.placed[name];
  if (!old) return points;
  return { ...points, placed: { ...points.placed, [name]: { ...old, hidden: !old.hidden } } };
}

export function remove(points: Points, name: PointName): Points {
  const { [name]: _, ...placed } = points.placed;
  return { ...points, placed };
}

export function skip(points: Points, name: PointName): Points {
  return {
    ...remove(points, name),
    skipped: [...points.skipped.filter((each) => each !== name), name],
    asked: points.asked === name ? null : points.asked,
  };
}

/** Skip everything that has not been placed. */
export function skipRest(points: Points): Points {
  return { ...points, skipped: POINT_NAMES.filter((name) => !points.placed[name]), asked: null };
}

export function ask(points: Points, name: PointName): Points {
  return { ...points, asked: name, skipped: points.skipped.filter((each) => each !== name) };
}

export function swapSides(points: Points): Points {
  const entries = Object.entries(points.placed) as [PointName, Place][];
  return {
    placed: Object.fromEntries(entries.map(([name, where]) => [mirrored(name), where])),
    skipped: points.skipped.map(mirrored),
    asked: points.asked === null ? null : mirrored(points.asked),
  };
}

export interface Missing {
  readonly limbs: number;
  readonly trunk: number;
}

/** How many points a body cannot do without are still missing. */
export function missing(points: Points): Missing {
  const count = (names: readonly PointName[]) => names.filter((name) => points.placed[name]).length;
  return {
    limbs: Math.max(0, LIMITS.limbPoints - count(LIMB_POINTS)),
    trunk: Math.max(0, LIMITS.trunkPoints - count(TRUNK_POINTS)),
  };
}

export function isEnough(points: Points): boolean {
  const { limbs, trunk } = missing(points);
  return limbs === 0 && trunk === 0;
}
