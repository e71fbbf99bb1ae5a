// What is known of the person, as typed; nothing typed means unknown.
import type { Gender } from "../api/types";

export interface Person {
  readonly gender: Gender | null;
  readonly units: "metric" | "imperial";
  readonly height: string;
  /** The inches beyond the feet. */
  readonly inches: string;
  readonly weight: string;
}

export const NOBODY: Person = { gender: null, units: "metric", height: "", inches: "", weight: "" };

export const HEIGHT_RANGE_M = [1.2, 2.3] as const;
const INCH_M = 0.0254;
const POUND_KG = 0.45359237;

/** A number, null for nothing, NaN for what is no number. */
function read(text: string): number | null {
  const trimmed = text.trim().replace(",", ".");
  return trimmed === "" ? null : Number(trimmed);
}

export function heightM(person: Person): number | null {
  const first = read(person.height);
  if (person.units === "metric") return first === null ? null : first / 100;
  const inches = read(person.inches);
  if (first === null && inches === null) return null;
  return ((first ?? 0) * 12 + (inches ?? 0)) * INCH_M;
}

export function weightKg(person: Person): number | null {
  const weight = read(person.weight);
  return weight === null || person.units === "metric" ? weight : weight * POUND_KG;
}

/** What is wrong with the height as typed; null if nothing is. */
export function heightFault(person: Person): string | null {
  const height = heightM(person);
  if (height === null) return null;
  const [low, high] = HEIGHT_RANGE_M;
  if (height >= low && height <= high) return null;
  if (Number.isNaN(height)) return "A number is needed here.";
  return person.units === "metric"
    ? `Between ${(low * 100).toFixed(0)} and ${(high * 100).toFixed(0)} cm, please.`
    : "Between 3 ft 11 in and 7 ft 6 in, please.";
}

export function weightFault(person: Person): string | null {
  const weight = weightKg(person);
  if (weight === null || (weight > 0 && weight <= 1000)) return null;
  return "A weight above zero is needed here.";
}

/** The same person in the other units. */
export function inUnits(person: Person, units: Person["units"]): Person {
  if (units === person.units) return person;
  const height = heightM(person);
  const weight = weightKg(person);
  const shown = { ...person, units };
  return { ...shown, ...heightTexts(height, units), weight: weightText(weight, units) };
}

export function heightTexts(height: number | null, units: Person["units"]): { height: string; inches: string } {
  if (height === null || Number.isNaN(height)) return { height: "", inches: "" };
  if (units === "metric") return { height: trimmed(height * 100, 1), inches: "" };
  const inches = Math.round((height / INCH_M) * 4) / 4;
  return { height: String(Math.floor(inches / 12)), inches: trimmed(inches % 12, 2) };
}

export function weightText(weight: number | null, units: Person["units"]): string {
  if (weight === null || Number.isNaN(weight)) return "";
  return trimmed(units === "metric" ? weight : weight / POUND_KG, 1);
}

function trimmed(value: number, digits: number): string {
  return String(Number(value.toFixed(digits)));
}
