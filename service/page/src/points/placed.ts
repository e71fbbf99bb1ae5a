// Placed points as a value, and what can be done to it; every change gives a new value.
import { LIMITS } from "../api/limits";
import { LIMB_POINTS, POINT_NAMES, TRUNK_POINTS, mirrored } from "./catalogue";
import type { PointName } from "./catalogue";

export interface Place {
  readonly x: number;
  readonly y: number;
  /** Behind something else: its place is a guess. */
  readonly hidden: boolean;
  /** The service says so, and nobody has moved or confirmed it. */
  readonly proposed: boolean;
}

export interface Points {
  readonly placed: Readonly<Partial<Record<PointName, Place>>>;
  readonly skipped: readonly PointName[];
  /** The point asked for out of turn, if any. */
  readonly asked: PointName | null;
  /** Proposed points that somebody should look at, in this order. */
  readonly doubts: readonly PointName[];
  /** Whose points were proposed: their place among the persons found. */
  readonly person: number | null;
}

export const NO_POINTS: Points = { placed: {}, skipped: [], asked: null, doubts: [], person: null };

/** The point to click next; null when all are placed or skipped. */
export function nextPoint(points: Points): PointName | null {
  if (points.asked !== null) return points.asked;
  return POINT_NAMES.find((name) => !points.placed[name] && !points.skipped.includes(name)) ?? null;
}

/** The point to be looked at next; none while one is to be clicked. */
export function nextDoubt(points: Points): PointName | null {
  return nextPoint(points) === null ? (points.doubts[0] ?? null) : null;
}

export function place(points: Points, name: PointName, x: number, y: number): Points {
  const hidden = points.placed[name]?.hidden ?? false;
  return {
    ...points,
    placed: { ...points.placed, [name]: { x, y, hidden, proposed: false } },
    skipped: without(points.skipped, name),
    asked: points.asked === name ? null : points.asked,
    doubts: without(points.doubts, name),
  };
}

/** Somebody says that a point is where it should be, and is seen there. */
export function confirm(points: Points, name: PointName): Points {
  const where = points.placed[name];
  if (!where) return points;
  return {
    ...points,
    placed: { ...points.placed, [name]: { ...where, hidden: false, proposed: false } },
    doubts: without(points.doubts, name),
  };
}

export function toggleHidden(points: Points, name: PointName): Points {
  return setHidden(points, name, !points.placed[name]?.hidden);
}

/** What is hidden may still be proposed: nobody has said where it is. */
export function setHidden(points: Points, name: PointName, hidden: boolean): Points {
  const old = points.placed[name];
  if (!old) return points;
  return { ...points, placed: { ...points.placed, [name]: { ...old, hidden } }, doubts: without(points.doubts, name) };
}

export function remove(points: Points, name: PointName): Points {
  const { [name]: _, ...placed } = points.placed;
  return { ...points, placed, doubts: without(points.doubts, name) };
}

export function skip(points: Points, name: PointName): Points {
  return {
    ...remove(points, name),
    skipped: [...without(points.skipped, name), name],
    asked: points.asked === name ? null : points.asked,
  };
}

/** Skip everything that has not been placed. */
export function skipRest(points: Points): Points {
  return { ...points, skipped: POINT_NAMES.filter((name) => !points.placed[name]), asked: null };
}

export function ask(points: Points, name: PointName): Points {
  return { ...points, asked: name, skipped: without(points.skipped, name) };
}

/** Ask no longer for a point that lies somewhere already. */
export function leave(points: Points): Points {
  return { ...points, asked: null };
}

export function swapSides(points: Points): Points {
  const entries = Object.entries(points.placed) as [PointName, Place][];
  return {
    ...points,
    placed: Object.fromEntries(entries.map(([name, where]) => [mirrored(name), where])),
    skipped: points.skipped.map(mirrored),
    asked: points.asked === null ? null : mirrored(points.asked),
    doubts: points.doubts.map(mirrored),
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

function without(names: readonly PointName[], name: PointName): readonly PointName[] {
  return names.includes(name) ? names.filter((each) => each !== name) : names;
}
