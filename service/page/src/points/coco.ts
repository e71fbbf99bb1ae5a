// Points from files and to files: COCO's annotation JSON, detectors' lists, and our own.
import { POINTS } from "../api/limits";
import { messages } from "../messages";
import { isPointName } from "./catalogue";
import type { PointName } from "./catalogue";
import { NO_POINTS } from "./placed";
import type { Place, Points } from "./placed";

const COCO_COUNT = 17;
export const COCO_NAMES: readonly PointName[] = POINTS.names.slice(0, COCO_COUNT);

type Placed = Partial<Record<PointName, Place>>;

/** Read points from JSON text; throws an Error that says what the file lacks. */
export function readPoints(text: string): Points {
  let content: unknown;
  try {
    content = JSON.parse(text);
  } catch {
    throw new Error(messages.points.files.notJson);
  }
  const placed = placedIn(content);
  if (Object.keys(placed).length === 0) throw new Error(messages.points.files.expected);
  return { ...NO_POINTS, placed };
}

/** A COCO file with one person, and beside COCO's seventeen points ours by name. */
export function cocoFile(points: Points, picture: { name: string; width: number; height: number }): string {
  const keypoints = COCO_NAMES.flatMap((name) => {
    const where = points.placed[name];
    return where ? [round(where.x), round(where.y), where.hidden ? 1 : 2] : [0, 0, 0];
  });
  const xs = Object.values(points.placed).map((where) => where.x);
  const ys = Object.values(points.placed).map((where) => where.y);
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const box = [left, top, Math.max(...xs) - left, Math.max(...ys) - top].map(round);
  const named = Object.fromEntries(
    Object.entries(points.placed).map(([name, where]) => [name, [round(where.x), round(where.y), where.hidden ? 1 : 2]]),
  );
  return JSON.stringify(
    {
      images: [{ id: 1, file_name: picture.name, width: picture.width, height: picture.height }],
      categories: [{ id: 1, name: "person", keypoints: COCO_NAMES }],
      annotations: [
        {
          id: 1,
          image_id: 1,
          category_id: 1,
          keypoints,
          num_keypoints: COCO_NAMES.filter((name) => points.placed[name]).length,
          bbox: box,
          area: round(box[2]! * box[3]!),
          iscrowd: 0,
          points: named,
        },
      ],
    },
    null,
    1,
  );
}

/** Points by name from a request, ours or an answer's. */
export function namedPoints(content: object): Placed {
  const placed: Placed = {};
  for (const [name, value] of Object.entries(content)) {
    if (!isPointName(name)) continue;
    const where = placeOf(value);
    if (where) placed[name] = where;
  }
  return placed;
}

function placedIn(content: unknown): Placed {
  if (Array.isArray(content)) {
    return isKeypoints(content) ? fromKeypoints(content) : content.length > 0 ? placedIn(content[0]) : {};
  }
  if (!isObject(content)) return {};
  if (Array.isArray(content.annotations)) {
    // The person with most points is the one that is meant.
    const found = content.annotations.map(placedIn);
    return found.sort((a, b) => Object.keys(b).length - Object.keys(a).length)[0] ?? {};
  }
  if (isObject(content.points)) return namedPoints(content.points);
  if (Array.isArray(content.keypoints)) return placedIn(content.keypoints);
  return namedPoints(content);
}

function isKeypoints(list: readonly unknown[]): boolean {
  const numbers = list.flat();
  return numbers.length === 3 * COCO_NAMES.length && numbers.every((each) => typeof each === "number");
}

function fromKeypoints(list: readonly unknown[]): Placed {
  const numbers = list.flat() as number[];
  const placed: Placed = {};
  COCO_NAMES.forEach((name, i) => {
    const where = placeOf(numbers.slice(3 * i, 3 * i + 3));
    if (where) placed[name] = where;
  });
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

function round(value: number): number {
  return Math.round(value * 100) / 100;
}
