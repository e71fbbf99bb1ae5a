// Which correction helps a doubtful fit of one picture most.
import type { FittedView } from "../api/fits";
import { namesOfProposed } from "../ui/proposed";
import { gradeOf } from "./grade";
import type { Judged } from "./grade";
import { isContradicted } from "./outcome";

export type Advice = "people" | "sides" | "clothes" | "mask" | "points" | "limbs" | "weight";

/** By warning, the surest first. */
const BY_WARNING: readonly (readonly [string, Advice])[] = [
  ["several-people", "people"],
  ["left-and-right-may-be-swapped", "sides"],
  ["shoulders-and-hips-disagree", "sides"],
  ["clothes-not-loose", "clothes"],
  ["segmentation-doubtful", "mask"],
  ["low-silhouette-overlap", "points"],
];

/** What a person's sides are told by. */
const TRUNK = ["left_shoulder", "right_shoulder", "left_hip", "right_hip"] as const;

interface Advised extends Judged {
  readonly measurements: readonly { readonly name: string; readonly given?: boolean }[];
  readonly views: readonly (Judged["views"][number] & Pick<FittedView, "assumptions"> & { readonly limb_facing: readonly { readonly ambiguous: boolean }[] })[];
}

/** Null where nothing is in doubt, where the picture has to be another one, and of several pictures, which say it each. */
export function adviceOf({ views, warnings, measurements }: Advised): Advice | null {
  const [view] = views;
  if (!view || views.length > 1 || isContradicted(view) || gradeOf(view) === "good") return null;
  const codes = new Set([...warnings, ...view.warnings].map(({ code }) => code));
  const warned = BY_WARNING.find(([code]) => codes.has(code));
  // Nobody swapped what nobody clicked: whoever looks over a shoulder shows both eyes from behind.
  const proposed = namesOfProposed(view.assumptions);
  if (warned?.[1] === "sides" && TRUNK.every((name) => proposed.includes(name))) return "points";
  if (warned) return warned[1];
  if (gradeOf(view) === "poor") return "points";
  if (view.limb_facing.some(({ ambiguous }) => ambiguous)) return "limbs";
  return measurements.some(({ name, given }) => name === "weight" && !given) ? "weight" : "points";
}
