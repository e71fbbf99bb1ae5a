// The points a person clicks, in the order they are asked for.

export const POINT_NAMES = [
  "left_shoulder",
  "right_shoulder",
  "left_elbow",
  "right_elbow",
  "left_wrist",
  "right_wrist",
  "left_hip",
  "right_hip",
  "left_knee",
  "right_knee",
  "left_ankle",
  "right_ankle",
  "head_top",
  "nose",
  "left_eye",
  "right_eye",
  "left_ear",
  "right_ear",
  "chin",
  "neck",
  "left_heel",
  "right_heel",
  "left_toe",
  "right_toe",
] as const;

export type PointName = (typeof POINT_NAMES)[number];
export type Side = "left" | "right" | "middle";

export const LIMB_POINTS: readonly PointName[] = POINT_NAMES.slice(0, 12);
export const TRUNK_POINTS: readonly PointName[] = ["left_shoulder", "right_shoulder", "left_hip", "right_hip"];

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
