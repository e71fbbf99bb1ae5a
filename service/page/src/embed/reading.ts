// What a site's messages say, field by field: the first that cannot be meant is named.
import { LIMITS } from "../api/limits";
import { LANGUAGES, languageOf } from "../messages/language";

/** Which field of a message is refused, and why: words for the site's programmers. */
export interface Refusal {
  readonly field: string;
  readonly reason: string;
}

const HEAVIEST_KG = 1000;

const THEMES: readonly unknown[] = ["light", "dark", "system"] satisfies readonly Maquette.Theme[];

const DEEDS: readonly unknown[] = ["save", "delete"] satisfies readonly Maquette.Deed[];

/** Null for a message that can be taken as a start. */
export function faultOfStart(message: object): Refusal | null {
  const { token, lang, theme, subject, pictures, allow } = message as Readonly<Record<string, unknown>>;
  return (
    unknownField(message, "", ["type", "token", "lang", "theme", "subject", "pictures", "allow"]) ??
    (isMissing(token) ? null : faultOfToken(token)) ??
    faultOfLanguage(lang) ??
    (isMissing(theme) ? null : faultOfTheme(theme)) ??
    faultOfSubject(subject) ??
    faultOfPictures(pictures) ??
    (isMissing(allow) ? null : faultOfAllowed(allow))
  );
}

function faultOfAllowed(allow: unknown): Refusal | null {
  if (Array.isArray(allow) && allow.every((each) => DEEDS.includes(each))) return null;
  return { field: "allow", reason: `What is allowed is a list of ${DEEDS.join(" and ")}.` };
}

export function faultOfToken(token: unknown): Refusal | null {
  if (typeof token === "string" && /^[\x21-\x7e]+$/.test(token)) return null;
  return { field: "token", reason: "A token is the text that POST /v1/tokens answered with." };
}

export function faultOfTheme(theme: unknown): Refusal | null {
  return THEMES.includes(theme) ? null : { field: "theme", reason: `A theme is one of ${THEMES.join(", ")}.` };
}

function faultOfLanguage(lang: unknown): Refusal | null {
  if (isMissing(lang) || (typeof lang === "string" && languageOf(lang) !== null)) return null;
  return { field: "lang", reason: `The page speaks ${LANGUAGES.join(" and ")}.` };
}

function faultOfSubject(subject: unknown): Refusal | null {
  if (isMissing(subject)) return null;
  if (!isRecord(subject)) return { field: "subject", reason: "A subject is an object." };
  const { gender, height_m, weight_kg } = subject;
  const [low, high] = LIMITS.heightM;
  if (!isMissing(gender) && gender !== "female" && gender !== "male") return { field: "subject.gender", reason: "A gender is female or male." };
  if (!isMissing(height_m) && !(typeof height_m === "number" && height_m >= low && height_m <= high)) {
    return { field: "subject.height_m", reason: `A height is a number of metres from ${low} to ${high}.` };
  }
  if (!isMissing(weight_kg) && !(typeof weight_kg === "number" && weight_kg > 0 && weight_kg <= HEAVIEST_KG)) {
    return { field: "subject.weight_kg", reason: `A weight is a number of kilograms above 0 and up to ${HEAVIEST_KG}.` };
  }
  return unknownField(subject, "subject.", ["gender", "height_m", "weight_kg"]);
}

function faultOfPictures(pictures: unknown): Refusal | null {
  if (isMissing(pictures)) return null;
  if (!isRecord(pictures)) return { field: "pictures", reason: "Pictures are an object." };
  for (const name of ["front", "side"]) {
    const picture = pictures[name];
    if (!isMissing(picture) && !(picture instanceof Blob)) return { field: `pictures.${name}`, reason: "A picture is a Blob or a File." };
  }
  return unknownField(pictures, "pictures.", ["front", "side"]);
}

function unknownField(message: object, above: string, known: readonly string[]): Refusal | null {
  const unknown = Object.keys(message).find((name) => !known.includes(name));
  return unknown === undefined ? null : { field: above + unknown, reason: `There is no such field: use ${known.join(", ")}.` };
}

function isRecord(value: unknown): value is Readonly<Record<string, unknown>> {
  return typeof value === "object" && value !== null && !Array.isArray(value) && !(value instanceof Blob);
}

function isMissing(value: unknown): value is null | undefined {
  return value === null || value === undefined;
}
