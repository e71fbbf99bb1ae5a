// People by name: their fits and scans, and what changed with time.
import { plural } from "../figures";

const fitsOf = (count: number) => plural(count, { one: "1 fit", other: `${count} fits` });
const scansOf = (count: number) => plural(count, { one: "1 scan", other: `${count} scans` });

export const people = {
  fold: "Name",
  name: "Name for this person, if you like",
  nameNote: "Fits and scans of one name are found together, and compared over time.",
  whose: "Whose",
  everybody: "Everybody’s",
  all: "Changes over time",
  noneHere: "This browser’s list has none of this person’s.",
  none: "Nothing is kept of this person.",
  has: (fits: number, scans: number) => (scans === 0 ? fitsOf(fits) : fits === 0 ? scansOf(scans) : `${fitsOf(fits)} and ${scansOf(scans)}`),
  overTime: "Over time",
  charted: "Measurements with a chart",
  bars: "Dots are fits, squares are scans. The bars are ranges: the true value lies in 95 % of them.",
  newestOnly: (count: string) => `Of the newest ${count}.`,
  tableOf: (measure: string) => `${measure} over time`,
  day: "Day",
  what: "Measured by",
  interval: "95 % range",
  kinds: { fit: "Fit", scan: "Scan" },
  changed: "What changed",
  since: (kind: string, moment: string) => `${kind} of ${moment}, compared with that of`,
  beyond: (count: number) => plural(count, { one: "One difference is more than chance explains:", other: `${count} differences are more than chance explains:` }),
  nothingBeyond: (since: string) => `Nothing has changed since ${since} by more than chance explains.`,
  within: "Chance alone explains as much as the others:",
  more: (measure: string, by: string) => `${measure}: ${by} more`,
  less: (measure: string, by: string) => `${measure}: ${by} less`,
  same: (measure: string) => `${measure}: the same, as given both times`,
  chance: (told: string, least: string) => `${told}; a change would show from ${least} on`,
  howCompared: (count: number) =>
    `${count} measurements are compared with both results’ errors. Where nothing has changed, at most one comparison in twenty names any change.`,
  records: "Fits and scans",
  erase: (label: string) => `Delete everything of ${label}`,
  eraseQuestion: (what: string) => `Delete ${what}, with pictures and all that was made of them? Nobody can bring them back.`,
  erased: (label: string) => `Everything of ${label} is deleted.`,
} as const;
