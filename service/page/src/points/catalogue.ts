// The points a person clicks, in the order they are asked for, and what each one means.

export const POINTS = [
  { name: "left_shoulder", label: "Left shoulder", help: "Where the arm turns: three fingers below the top of the shoulder." },
  { name: "right_shoulder", label: "Right shoulder", help: "Where the arm turns: three fingers below the top of the shoulder." },
  { name: "left_elbow", label: "Left elbow", help: "The middle of the elbow, between its inner and outer side." },
  { name: "right_elbow", label: "Right elbow", help: "The middle of the elbow, between its inner and outer side." },
  { name: "left_wrist", label: "Left wrist", help: "Where the hand begins, in the middle of the wrist." },
  { name: "right_wrist", label: "Right wrist", help: "Where the hand begins, in the middle of the wrist." },
  { name: "left_hip", label: "Left hip", help: "Where the thigh turns: just above the crotch, halfway from the middle to the outer edge. Not the waist." },
  { name: "right_hip", label: "Right hip", help: "Where the thigh turns: just above the crotch, halfway from the middle to the outer edge. Not the waist." },
  { name: "left_knee", label: "Left knee", help: "The middle of the knee cap." },
  { name: "right_knee", label: "Right knee", help: "The middle of the knee cap." },
  { name: "left_ankle", label: "Left ankle", help: "Between the two ankle bones." },
  { name: "right_ankle", label: "Right ankle", help: "Between the two ankle bones." },
  { name: "head_top", label: "Top of the head", help: "The crown, beneath the hair." },
  { name: "nose", label: "Nose", help: "The tip of the nose." },
  { name: "left_eye", label: "Left eye", help: "The middle of the eye." },
  { name: "right_eye", label: "Right eye", help: "The middle of the eye." },
  { name: "left_ear", label: "Left ear", help: "Where the ear meets the head." },
  { name: "right_ear", label: "Right ear", help: "Where the ear meets the head." },
  { name: "chin", label: "Chin", help: "The tip of the chin." },
  { name: "neck", label: "Neck", help: "The pit of the throat, between the collar bones." },
  { name: "left_heel", label: "Left heel", help: "The rear end of the heel." },
  { name: "right_heel", label: "Right heel", help: "The rear end of the heel." },
  { name: "left_toe", label: "Left toes", help: "The tip of the big toe." },
  { name: "right_toe", label: "Right toes", help: "The tip of the big toe." },
] as const;

export type PointName = (typeof POINTS)[number]["name"];
export type Side = "left" | "right" | "middle";

export const POINT_NAMES: readonly PointName[] = POINTS.map((point) => point.name);
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

export function pointOf(name: PointName): (typeof POINTS)[number] {
  return POINTS[POINT_NAMES.indexOf(name)]!;
}

export function sideOf(name: PointName): Side {
  return name.startsWith("left_") ? "left" : name.startsWith("right_") ? "right" : "middle";
}

/** The same point of the other side; itself where there is but one. */
export function mirrored(name: PointName): PointName {
  const other = name.startsWith("left_") ? name.replace("left_", "right_") : name.replace("right_", "left_");
  return other as PointName;
}
