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
};

export function measureLabel(name: string): string {
  const text = LABELS[name] ?? name.replace(/_girth$/, "").replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
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
