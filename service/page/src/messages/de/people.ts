// People by name: their fits and scans, and what changed with time.
import type { Messages } from "../catalogue";
import { plural } from "../figures";

const fitsOf = (count: number) => plural(count, { one: "1 Auswertung", other: `${count} Auswertungen` });
const scansOf = (count: number) => plural(count, { one: "1 Scan", other: `${count} Scans` });

export const people: Messages["people"] = {
  fold: "Name",
  name: "Name für diese Person, wenn Sie möchten",
  nameNote: "Was denselben Namen hat, finden Sie beisammen und im Vergleich über die Zeit.",
  whose: "Von wem",
  everybody: "Von allen",
  all: "Verlauf der Maße",
  noneHere: "Die Liste dieses Browsers hat nichts von dieser Person.",
  none: "Von dieser Person ist nichts gespeichert.",
  has: (fits, scans) => (scans === 0 ? fitsOf(fits) : fits === 0 ? scansOf(scans) : `${fitsOf(fits)} und ${scansOf(scans)}`),
  overTime: "Verlauf",
  charted: "Maße mit Diagramm",
  bars: "Punkte sind Auswertungen, Quadrate sind Scans, nach dem Tag, an dem sie entstanden. 95 von 100 Balken enthalten den wahren Wert.",
  newestOnly: (count) => `Von den neuesten ${count}.`,
  tableOf: (measure) => `${measure} im Verlauf`,
  day: "Tag",
  what: "Gemessen durch",
  interval: "95-%-Intervall",
  kinds: { fit: "Auswertung", scan: "Scan" },
  changed: "Was sich geändert hat",
  since: (kind, moment) => `${kind} vom ${moment}, verglichen mit`,
  beyond: (count) =>
    plural(count, { one: "Ein Unterschied ist größer, als der Zufall erklärt:", other: `${count} Unterschiede sind größer, als der Zufall erklärt:` }),
  nothingBeyond: (since) => `Nichts hat sich seit dem ${since} stärker geändert, als der Zufall erklärt.`,
  within: "Die übrigen Unterschiede erklärt schon der Zufall:",
  more: (measure, by) => `${measure}: ${by} mehr`,
  less: (measure, by) => `${measure}: ${by} weniger`,
  same: (measure) => `${measure}: gleich, beide Male angegeben`,
  chance: (told, least) => `${told}; eine Änderung wäre ab ${least} zu erkennen`,
  howCompared: (count) =>
    `Verglichen werden ${count} Maße mit den Fehlern beider Ergebnisse. Wo sich nichts geändert hat, nennt höchstens einer von zwanzig Vergleichen eine Änderung.`,
  records: "Auswertungen und Scans",
  erase: (label) => `Alles von ${label} löschen`,
  eraseQuestion: (what) => `${what} löschen, mit den Bildern und allem, was daraus entstand? Niemand kann sie zurückholen.`,
  erased: (label) => `Alles von ${label} ist gelöscht.`,
};
