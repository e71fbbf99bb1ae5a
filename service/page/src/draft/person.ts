// What is known of the person, as typed; nothing typed means unknown.
import { LIMITS } from "../api/limits";
import type { FitRequest, Gender, KnownMeasurements } from "../api/types";
import { decimal, measured, typed } from "../messages/figures";
import { messages } from "../messages";
import { INCH_M, feetAndInches, feetTexts, read, readInches } from "./feet";

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
export const TAPE_RANGE_CM = [10, 200] as const;

const INCH_CM = 100 * INCH_M;
const POUND_KG = 0.45359237;

export function heightM(person: Person): number | null {
  const isMetric = person.units === "metric";
  const said = isMetric ? read(person.height) : readInches(person.height, person.inches);
  return said === null ? null : said * (isMetric ? 0.01 : INCH_M);
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
  const { faults } = messages.person;
  if (Number.isNaN(height)) return faults.number;
  if (person.units === "metric") return faults.height(decimal(low * 100), heightInWords(high, "metric"));
  const [least, most] = [Math.ceil(low / INCH_M), Math.floor(high / INCH_M)].map((inches) => heightInWords(inches * INCH_M, "imperial"));
  return faults.height(least!, most!);
}

export function weightFault(person: Person): string | null {
  const weight = weightKg(person);
  if (weight === null || (weight > 0 && weight <= 1000)) return null;
  return messages.person.faults.weight;
}

export function inches(cm: number): number {
  return cm / INCH_CM;
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
    texts[name] = typed(units === "metric" ? cm : cm / INCH_CM, 1);
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
  if (units === "metric") return { height: typed(height * 100, 1), inches: "" };
  return feetTexts(height);
}

/** "165 cm", "5 ft 5 in". */
export function heightInWords(height: number, units: Person["units"]): string {
  if (units === "metric") return measured(height * 100, "centimeter");
  return `${feetAndInches(height, 0)} ${symbols().in}`;
}

/** The person of a request, to tell fits apart by: "Woman, 165 cm". */
export function personInWords(asked: Pick<FitRequest, "gender" | "height_m">, units: Person["units"]): string {
  const { words } = messages.person;
  const who = words[asked.gender];
  if (asked.height_m == null) return who;
  const { height } = heightTexts(asked.height_m, "metric");
  return words.with(who, units === "metric" ? `${height} ${symbols().cm}` : heightInWords(asked.height_m, units));
}

function symbols() {
  return messages.person.symbols;
}

export function weightText(weight: number | null, units: Person["units"]): string {
  if (weight === null || Number.isNaN(weight)) return "";
  return typed(units === "metric" ? weight : weight / POUND_KG, 1);
}

