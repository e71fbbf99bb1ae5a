// Measurements as a person reads them.
import { MEASUREMENTS } from "../api/limits";
import type { Measurement } from "../api/types";
import { feetAndInches } from "../draft/feet";
import type { Person } from "../draft/person";
import { plainName, wordFor } from "../messages/words";
import { capitalised, decimal } from "../messages/figures";
import { messages } from "../messages";

const CM_PER_INCH = 2.54;
const CM_PER_M = 100;
const STATURE = "stature";
const KG_PER_POUND = 0.45359237;
/** So many standard errors to either side hold 95 of 100. */
const WITHIN_95 = 1.96;

export const INTERVAL_SHARE = 0.95;

export function measureLabel(name: string): string {
  return wordFor(messages.measures.labels, name) ?? capitalised(plainName(name));
}

/** What stands beside the body, where there is room for a word or two. */
export function shortLabel(name: string): string {
  return wordFor(messages.measures.short, name) ?? measureLabel(name);
}

/** What most people ask for: shown first, and drawn on the body before one is chosen. */
const CHIEF: ReadonlySet<string> = new Set(MEASUREMENTS.chief);

export function isChief(name: string): boolean {
  return CHIEF.has(name);
}

export interface MeasureGroup<M> {
  readonly heading: string;
  readonly members: readonly M[];
}

/** All that is not chief, under headings. */
export function furtherMeasures<M extends { readonly name: string }>(measurements: readonly M[]): readonly MeasureGroup<M>[] {
  const further = measurements.filter((each) => !isChief(each.name));
  return GROUPS
    .map((group) => ({
      heading: messages.measures.groups[group],
      members: further.filter((each) => MEASUREMENTS.groups[group].includes(each.name)),
    }))
    .filter((group) => group.members.length > 0);
}

const GROUPS = ["girths", "lengths", "heights", "breadths"] as const;

export interface Shown {
  readonly value: string;
  readonly unit: string;
  /** 95 of 100 such intervals hold the truth, if the fit's own model is right. */
  readonly interval: string | null;
}

export function shown(measurement: Measurement, units: Person["units"]): Shown {
  const { factor, unit } = inUnit(measurement.unit, units);
  const isInFeet = units === "imperial" && measurement.name === STATURE;
  const text = (value: number) => (isInFeet ? feetAndInches(value / CM_PER_M, 1) : decimal(value * factor, 1));
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

function inUnit(unit: string, units: Person["units"]): { factor: number; unit: string } {
  if (units === "metric") return { factor: 1, unit };
  return unit === "kg" ? { factor: 1 / KG_PER_POUND, unit: "lb" } : { factor: 1 / CM_PER_INCH, unit: "in" };
}
