// Measurements as a person reads them.
import type { FitResult, Measurement } from "../api/types";
import type { Person } from "../draft/person";

const CM_PER_INCH = 2.54;
const KG_PER_POUND = 0.45359237;
const WITHIN_95 = 1.96;

const LABELS: Readonly<Record<string, string>> = {
  stature: "Height",
  waist_girth_navel: "Waist, at the navel",
  waist_girth_smallest: "Waist, smallest",
  back_waist_length: "Back length",
  front_waist_length: "Front length",
  trunk_girth: "Trunk, from shoulder through crotch",
  armscye_girth: "Armhole",
  back_shoulder_width: "Shoulder to shoulder, over the back",
  cross_back: "Across the back",
  cross_front: "Across the chest",
  bust_point_width: "Bust points",
  neck_to_bust_point: "Neck to bust point",
  body_rise: "Rise, straight down",
  front_rise: "Rise in front",
  back_rise: "Rise behind",
  waist_to_hip: "Waist down to hip",
  cervicale_height: "Nape height",
  neck_height: "Height of the pit of the neck",
  head_height: "Head, crown to chin",
};

export function measureLabel(name: string): string {
  const text = LABELS[name] ?? name.replace(/_girth$/, "").replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** What most people ask for: shown first, and drawn on the body before one is chosen. */
const CHIEF: ReadonlySet<string> = new Set([
  "stature",
  "weight",
  "head_girth",
  "neck_girth",
  "chest_girth",
  "under_bust_girth",
  "waist_girth_smallest",
  "waist_girth_navel",
  "hip_girth",
  "upper_arm_girth",
  "forearm_girth",
  "wrist_girth",
  "thigh_girth",
  "knee_girth",
  "calf_girth",
  "ankle_girth",
  "shoulder_breadth",
  "back_shoulder_width",
  "arm_length",
  "sleeve_length",
  "back_waist_length",
  "crotch_length",
  "inseam",
  "outseam",
]);

export function isChief(name: string): boolean {
  return CHIEF.has(name);
}

export interface MeasureGroup<M> {
  readonly heading: string;
  readonly members: readonly M[];
}

/** All that is not chief, under headings; the names tell what they are. */
export function furtherMeasures<M extends { readonly name: string }>(measurements: readonly M[]): readonly MeasureGroup<M>[] {
  const further = measurements.filter((each) => !isChief(each.name));
  return ["Girths", "Lengths", "Above the floor", "Breadths and depths"]
    .map((heading) => ({ heading, members: further.filter((each) => groupOf(each.name) === heading) }))
    .filter((group) => group.members.length > 0);
}

function groupOf(name: string): string {
  if (name.split("_").includes("girth")) return "Girths";
  // Of the heights one is the head's own.
  if (name.endsWith("_height") && name !== "head_height") return "Above the floor";
  return /_(breadth|depth)$/.test(name) ? "Breadths and depths" : "Lengths";
}

export interface Shown {
  readonly value: string;
  readonly unit: string;
  /** 95 of 100 such intervals hold the truth, if the fit's own model is right. */
  readonly interval: string | null;
}

export function shown(measurement: Measurement, units: Person["units"]): Shown {
  const { factor, unit } = inUnit(measurement.unit, units);
  const text = (value: number) => (value * factor).toFixed(1);
  const error = measurement.standard_error;
  // What was given exactly has an error of zero, up to rounding.
  const isKnown = error === null || error === undefined || error < 1e-3;
  return {
    value: text(measurement.value),
    unit,
    interval: isKnown
      ? null
      : `${text(measurement.value - WITHIN_95 * error)} – ${text(measurement.value + WITHIN_95 * error)}`,
  };
}

export function difference(measurement: Measurement, other: Measurement, units: Person["units"]): string {
  const { factor } = inUnit(measurement.unit, units);
  const by = (measurement.value - other.value) * factor;
  return Math.abs(by) < 0.05 ? "0.0" : `${by > 0 ? "+" : "−"}${Math.abs(by).toFixed(1)}`;
}

/** The same measurements by silhouette and edges alone; null where shading was not used. */
export function withoutShading(result: FitResult): readonly Measurement[] | null {
  if (result.cues !== "SES") return null;
  return result.stages.find((stage) => stage.name === "SE")?.measurements ?? null;
}

function inUnit(unit: string, units: Person["units"]): { factor: number; unit: string } {
  if (units === "metric") return { factor: 1, unit };
  return unit === "kg" ? { factor: 1 / KG_PER_POUND, unit: "lb" } : { factor: 1 / CM_PER_INCH, unit: "in" };
}
