// Heights in feet and inches: as people type them, and as they are told.
import { decimal, typed } from "../messages/figures";
import { messages } from "../messages";

export const INCH_M = 0.0254;
const PER_FOOT = 12;

/** Nobody is so many feet tall: a number from here on is one of inches. */
const INCHES_FROM = 20;
/** Less than this is lost where the fewest digits are sought: it comes back as the same tenth of a centimetre. */
const LOST_M = 0.00045;

const NUMBER = String.raw`(\d+(?:[.,]\d*)?|[.,]\d+)`;
/** "5'11", "5 ft 11.7 in". */
const FEET_AND_INCHES = new RegExp(String.raw`^${NUMBER}\s*(?:ft\.?|feet|foot|['’′])\s*(?:${NUMBER}\s*(?:in\.?|inch(?:es)?|["”″]|''|’’)?)?$`, "i");
const INCHES = new RegExp(String.raw`^${NUMBER}\s*(?:in\.?|inch(?:es)?|["”″]|'')$`, "i");

/** A number, null for nothing, NaN for what is no number. */
export function read(text: string): number | null {
  const trimmed = text.trim().replace(",", ".");
  return trimmed === "" ? null : Number(trimmed);
}

/** In inches, of what stands in the field for feet and in that for the inches beyond; null for nothing, NaN for no height. */
export function readInches(first: string, second: string): number | null {
  const beyond = read(second);
  const both = FEET_AND_INCHES.exec(first.trim());
  const alone = INCHES.exec(first.trim());
  const said = both?.[2] ?? alone?.[1];
  // Inches in either field, not in both.
  if (said !== undefined && beyond !== null) return NaN;
  if (alone) return read(alone[1]!);
  const feet = read(both ? both[1]! : first);
  if (feet === null) return beyond;
  if (!both && beyond === null && feet >= INCHES_FROM) return feet;
  return feet * PER_FOOT + (said === undefined ? (beyond ?? 0) : read(said)!);
}

/** As one would type it, with the fewest digits that say it. */
export function feetTexts(heightM: number): { height: string; inches: string } {
  const exact = heightM / INCH_M;
  const rounded = [0, 1].map((digits) => Number(exact.toFixed(digits)));
  const inches = rounded.find((each) => Math.abs(each * INCH_M - heightM) < LOST_M) ?? Number(exact.toFixed(2));
  return { height: String(Math.floor(inches / PER_FOOT)), inches: typed(inches % PER_FOOT, 2) };
}

/** "5 ft 11.0", its unit of inches left to whoever shows it. */
export function feetAndInches(heightM: number, digits: number): string {
  const inches = Number((heightM / INCH_M).toFixed(digits));
  const feet = Math.floor(inches / PER_FOOT);
  return `${decimal(feet)} ${messages.person.symbols.ft} ${decimal(inches - feet * PER_FOOT, digits)}`;
}
