// Points by name, as requests and answers have them.
import { isPointName } from "./catalogue";
import type { PointName } from "./catalogue";
import type { Place } from "./placed";

/** Points by name from a request, ours or an answer's. */
export function namedPoints(content: object): Partial<Record<PointName, Place>> {
  const placed: Partial<Record<PointName, Place>> = {};
  for (const [name, value] of Object.entries(content)) {
    if (!isPointName(name)) continue;
    const where = placeOf(value);
    if (where) placed[name] = where;
  }
  return placed;
}

function placeOf(value: unknown): Place | null {
  const triple = isObject(value) ? [value.x, value.y, value.visibility ?? 2] : Array.isArray(value) ? value : [];
  const [x, y, visibility = 2] = triple as unknown[];
  if (typeof x !== "number" || typeof y !== "number" || visibility === 0) return null;
  return { x, y, hidden: visibility === 1, proposed: isObject(value) && value.source === "proposal" };
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
