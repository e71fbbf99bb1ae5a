// The points a person clicks, in the order they are asked for.

import { POINTS } from "../api/limits";
import type { PointName } from "../api/types";

export type { PointName };

export const LIMB_POINTS = POINTS.limbs;
export const TRUNK_POINTS = POINTS.trunk;

const HEAD_FIRST: readonly PointName[] = ["head_top", "nose"];
const FURTHER = POINTS.names.filter((name) => !LIMB_POINTS.includes(name));

export const POINT_NAMES: readonly PointName[] = [
  ...LIMB_POINTS,
  ...HEAD_FIRST,
  ...FURTHER.filter((name) => !HEAD_FIRST.includes(name)),
];

export type Side = "left" | "right" | "middle";

export const BONES: readonly (readonly [PointName, PointName])[] = [
  ["left_shoulder", "right_shoulder"],
  ["left_hip", "right_hip"],
  ["left_shoulder", "left_hip"],
  ["right_shoulder", "right_hip"],
  ["left_shoulder", "left_elbow"],
  ["left_elbow", "left_wrist"],
  ["right_shoulder", "right_elbow"],
  ["right_elbow", "right_wrist"],
  ["left_hip", "left_knee"],
  ["left_knee", "left_ankle"],
  ["right_hip", "right_knee"],
  ["right_knee", "right_ankle"],
  ["left_ankle", "left_heel"],
  ["left_heel", "left_toe"],
  ["right_ankle", "right_heel"],
  ["right_heel", "right_toe"],
  ["neck", "chin"],
  ["nose", "left_eye"],
  ["nose", "right_eye"],
  ["left_eye", "left_ear"],
  ["right_eye", "right_ear"],
];

export function isPointName(name: string): name is PointName {
  return (POINT_NAMES as readonly string[]).includes(name);
}

export function sideOf(name: PointName): Side {
  return name.startsWith("left_") ? "left" : name.startsWith("right_") ? "right" : "middle";
}

/** The same point of the other side; itself where there is but one. */
export function mirrored(name: PointName): PointName {
  const other = name.startsWith("left_") ? name.replace("left_", "right_") : name.replace("right_", "left_");
  return other as PointName;
}
