// Whether left and right look swapped: of the whole person, or of one pair of joints.
import { LIMITS } from "../api/limits";
import { mirrored } from "./catalogue";
import type { PointName } from "./catalogue";
import type { Place, Points } from "./placed";

export interface SideDoubt {
  /** `behind`: the back is turned, or all sides are swapped; `facing`: the face says they are. */
  readonly kind: "behind" | "facing" | "hips" | "arms" | "legs";
  /** What swapping would mend: these and their mirror images. */
  readonly names: readonly PointName[];
}

type Placed = Points["placed"];

const TRUNK: readonly PointName[] = ["left_shoulder", "left_hip"];
const ARM: readonly PointName[] = ["left_elbow", "left_wrist"];
const LEG: readonly PointName[] = ["left_knee", "left_ankle", "left_heel", "left_toe"];
const FACE: readonly PointName[] = ["left_eye", "left_ear"];
const ALL: readonly PointName[] = [...TRUNK, ...ARM, ...LEG, ...FACE];

/** Of two shoulders alone: this share of their distance must lie along the picture. */
const LEVEL = 0.6;

export function sideDoubt({ placed }: Points): SideDoubt | null {
  const across = acrossTrunk(placed);
  const shoulders = across("shoulder");
  if (shoulders === 0) return null;
  const [hips, knees] = [across("hip"), across("knee")];
  // Legs that go with the hips were swapped with them.
  if (hips === -shoulders) return { kind: "hips", names: knees === hips ? ["left_hip", ...LEG] : ["left_hip"] };
  if (shoulders < 0) return { kind: showsFace(placed) ? "facing" : "behind", names: ALL };
  if (across("elbow") < 0) return { kind: "arms", names: ARM };
  if (knees < 0) return { kind: "legs", names: LEG };
  return null;
}

/** Some points put where their mirror images were, and those where they were. */
export function swapped(points: Points, names: readonly PointName[]): Points {
  const placed = { ...points.placed };
  for (const name of names) {
    const other = mirrored(name);
    const [here, there] = [points.placed[name], points.placed[other]];
    delete placed[name];
    delete placed[other];
    if (there) placed[name] = there;
    if (here) placed[other] = here;
  }
  const moves = (name: PointName) => names.includes(name) || names.includes(mirrored(name));
  return { ...points, placed, doubts: points.doubts.map((name) => (moves(name) ? mirrored(name) : name)) };
}

type Pair = "shoulder" | "elbow" | "hip" | "knee";

/** On which side, head up, the left one of a pair lies: 1 the picture's right, -1 its left, 0 unclear. */
function acrossTrunk(placed: Placed): (pair: Pair) => number {
  const { left_shoulder, right_shoulder, left_hip, right_hip } = placed;
  if (!left_shoulder || !right_shoulder) return () => 0;
  if (!left_hip || !right_hip) {
    const dx = left_shoulder.x - right_shoulder.x;
    const isLevel = Math.abs(dx) > LEVEL * distance(left_shoulder, right_shoulder);
    return (pair) => (pair === "shoulder" && isLevel ? Math.sign(dx) : 0);
  }
  const [top, bottom] = [middle(left_shoulder, right_shoulder), middle(left_hip, right_hip)];
  const length = Math.max(distance(top, bottom), 1e-9);
  // The trunk's upward direction, turned clockwise as the picture shows it.
  const right = { x: (bottom.y - top.y) / length, y: (top.x - bottom.x) / length };
  return (pair) => {
    const [a, b] = [placed[`left_${pair}`], placed[`right_${pair}`]];
    if (!a || !b) return 0;
    const along = ((a.x - b.x) * right.x + (a.y - b.y) * right.y) / length;
    return Math.abs(along) > LIMITS.clearBreadth ? Math.sign(along) : 0;
  };
}

/** A detector puts a face on the back of a head as well: only what somebody clicked is seen. */
function showsFace(placed: Placed): boolean {
  return (["nose", "left_eye", "right_eye"] as const).some(
    (name) => placed[name] && !placed[name].hidden && !placed[name].proposed,
  );
}

function middle(a: Place, b: Place): { x: number; y: number } {
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
}

function distance(a: { x: number; y: number }, b: { x: number; y: number }): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}
