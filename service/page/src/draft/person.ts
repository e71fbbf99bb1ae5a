// What is known of the person, as typed; nothing typed means unknown.
import { LIMITS } from "../api/limits";
import type { FitOptions, Gender, KnownMeasurements } from "../api/types";

export interface Person {
  readonly gender: Gender | null;
  readonly units: "metric" | "imperial";
  readonly height: string;
  /** The inches beyond the feet. */
  readonly inches: string;
  readonly weight: string;
  /** What a tape said, by the measurement's name. */
  readonly tape: Readonly<Partial<Record<TapeName, string>>>;
}

/** What people know of themselves, in the order it is asked for. */
export const TAPE_NAMES = [
  "chest_girth",
  "waist_girth_navel",
  "hip_girth",
  "thigh_girth",
  "neck_girth",
  "upper_arm_girth",
  "calf_girth",
  "inseam",
] as const;
export type TapeName = (typeof TAPE_NAMES)[number];

export const NOBODY: Person = { gender: null, units: "metric", height: "", inches: "", weight: "", tape: {} };

/** How far a tape errs: what it says is not held exactly. */
const TAPE_ERROR_CM = 1;
const TAPE_RANGE_CM = [10, 200] as const;

const INCH_M = 0.0254;
const INCH_CM = 100 * INCH_M;
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
  const [low, high] = LIMITS.heightM;
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

function tapeCm(person: Person, name: TapeName): number | null {
  const said = read(person.tape[name] ?? "");
  return said === null || person.units === "metric" ? said : said * INCH_CM;
}

/** What the tape said as the API wants it; nothing of what is no number. */
export function tapeMeasurements(person: Person): KnownMeasurements {
  const known: KnownMeasurements = {};
  for (const name of TAPE_NAMES) {
    const value = tapeCm(person, name);
    if (value !== null && !Number.isNaN(value)) known[name] = { value, standard_error: TAPE_ERROR_CM };
  }
  return known;
}

/** The first measurement that cannot be meant as typed; null if there is none. */
export function tapeFault(person: Person): TapeName | null {
  const [low, high] = TAPE_RANGE_CM;
  const isFault = (name: TapeName) => {
    const value = tapeCm(person, name);
    return value !== null && !(value >= low && value <= high);
  };
  return TAPE_NAMES.find(isFault) ?? null;
}

export function tapeTexts(known: KnownMeasurements, units: Person["units"]): Person["tape"] {
  const texts: Partial<Record<TapeName, string>> = {};
  for (const name of TAPE_NAMES) {
    const said = known[name];
    if (said === undefined) continue;
    const cm = typeof said === "number" ? said : said.value;
    texts[name] = trimmed(units === "metric" ? cm : cm / INCH_CM, 1);
  }
  return texts;
}

/** The same person in the other units. */
export function inUnits(person: Person, units: Person["units"]): Person {
  if (units === person.units) return person;
  const height = heightM(person);
  const weight = weightKg(person);
  const shown = { ...person, units };
  return {
    ...shown,
    ...heightTexts(height, units),
    weight: weightText(weight, units),
    tape: tapeTexts(tapeMeasurements(person), units),
  };
}

export function heightTexts(height: number | null, units: Person["units"]): { height: string; inches: string } {
  if (height === null || Number.isNaN(height)) return { height: "", inches: "" };
  if (units === "metric") return { height: trimmed(height * 100, 1), inches: "" };
  const inches = Math.round((height / INCH_M) * 4) / 4;
  return { height: String(Math.floor(inches / 12)), inches: trimmed(inches % 12, 2) };
}

/** The person of a request, to tell fits apart by: "Woman, 165 cm". */
export function personInWords(asked: Pick<FitOptions, "gender" | "height_m">, units: Person["units"]): string {
  const who = asked.gender === "female" ? "Woman" : "Man";
  const { height, inches } = heightTexts(asked.height_m ?? null, units);
  if (height === "") return who;
  return `${who}, ${units === "metric" ? `${height} cm` : `${height} ft ${inches} in`}`;
}

export function weightText(weight: number | null, units: Person["units"]): string {
  if (weight === null || Number.isNaN(weight)) return "";
  return trimmed(units === "metric" ? weight : weight / POUND_KG, 1);
}

function trimmed(value: number, digits: number): string {
  return String(Number(value.toFixed(digits)));
}
