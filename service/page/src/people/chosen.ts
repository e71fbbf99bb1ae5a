// Measurements that change with time in adults: what is compared is settled before anybody sees how they differ.
import { signal } from "@preact/signals";

export const COMPARED = [
  "weight",
  "chest_girth",
  "waist_girth_navel",
  "hip_girth",
  "thigh_girth",
  "upper_arm_girth",
  "calf_girth",
  "neck_girth",
] as const;
export type Compared = (typeof COMPARED)[number];

/** Those with a chart. */
export const charted = signal<readonly Compared[]>(["weight", "waist_girth_navel", "hip_girth"]);
