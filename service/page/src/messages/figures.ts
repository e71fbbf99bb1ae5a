// Numbers, units, dates and plurals as English writes them.
/** English as this browser writes it: its region says how numbers and dates look. */
const LOCALE = globalThis.navigator?.languages?.find((tag) => tag.startsWith("en")) ?? "en";

type Unit = "centimeter" | "meter" | "millimeter" | "kilogram" | "foot" | "inch" | "kilobyte" | "megabyte";

/** A number with so many digits behind the comma. */
export function decimal(value: number, digits = 0): string {
  return number({ minimumFractionDigits: digits, maximumFractionDigits: digits }).format(value);
}

/** A number as somebody would type it: at most so many digits, no marks between thousands. */
export function typed(value: number, digits: number): string {
  return number({ maximumFractionDigits: digits, useGrouping: false }).format(value);
}

export function percent(share: number, digits = 0): string {
  return number({ style: "percent", minimumFractionDigits: digits, maximumFractionDigits: digits }).format(share);
}

export function measured(value: number, unit: Unit, digits = 0): string {
  return number({ style: "unit", unit, minimumFractionDigits: digits, maximumFractionDigits: digits }).format(value);
}

/** The short form of a degree is a word in English. */
export function degrees(value: number): string {
  return number({ style: "unit", unit: "degree", unitDisplay: "narrow", maximumFractionDigits: 0 }).format(value);
}

/** The short form of a second is "sec"; its symbol is the same everywhere. */
export function seconds(value: number, digits: number): string {
  return `${decimal(value, digits)} s`;
}

const HOURS_PER_DAY = 24;

/** In days from two on, otherwise in hours: "7 days", "36 hours". */
export function duration(hours: number): string {
  const isDays = hours >= 2 * HOURS_PER_DAY;
  const unit = isDays ? "day" : "hour";
  return number({ style: "unit", unit, unitDisplay: "long", maximumFractionDigits: 1 }).format(isDays ? hours / HOURS_PER_DAY : hours);
}

export function moment(iso: string): string {
  return new Intl.DateTimeFormat(LOCALE, { dateStyle: "medium", timeStyle: "short" }).format(new Date(iso));
}

export function listed(parts: readonly string[]): string {
  return new Intl.ListFormat(LOCALE).format(parts);
}

/** One of them. */
export function either(parts: readonly string[]): string {
  return new Intl.ListFormat(LOCALE, { type: "disjunction" }).format(parts);
}

/** The form that goes with a count. */
export function plural(count: number, forms: { readonly one: string; readonly other: string }): string {
  return new Intl.PluralRules(LOCALE).select(count) === "one" ? forms.one : forms.other;
}

/** As a sentence begins. */
export function capitalised(text: string): string {
  return text.charAt(0).toLocaleUpperCase(LOCALE) + text.slice(1);
}

function number(options: Intl.NumberFormatOptions): Intl.NumberFormat {
  return new Intl.NumberFormat(LOCALE, options);
}
