// Who is in the picture.
import type { Messages } from "../catalogue";
import { plural } from "../figures";

export const person: Messages["person"] = {
  title: "Person",
  metric: "cm, kg",
  imperial: "ft, lb",
  body: "Körper",
  female: "Weiblich",
  male: "Männlich",
  height: "Körperhöhe",
  inches: "Körperhöhe, Zoll zusätzlich zu den Fuß",
  weight: "Gewicht",
  symbols: { cm: "cm", ft: "ft", in: "in", kg: "kg", lb: "lb" },
  heightHeld: "Die Körperhöhe gilt genau wie angegeben.",
  meanHeight: "Ohne Körperhöhe wird der Mittelwert des Geschlechts angenommen.",
  assumedHeight: (height) => `Ohne Angabe wird eine Körperhöhe von ${height} angenommen.`,
  weightHelps: "Am meisten hilft das Gewicht, wenn Sie es wissen: Ein einziges Bild zeigt nicht, wie tief ein Körper ist.",
  faults: {
    number: "Hier wird eine Zahl gebraucht.",
    height: (low, high) => `Bitte zwischen ${low} und ${high}.`,
    weight: "Hier wird ein Gewicht über null gebraucht.",
    tape: (measure, low, high) => `${measure}: bitte zwischen ${low} und ${high}.`,
  },
  known: "Bekannte Maße",
  given: (count) => plural(count, { one: "1 angegeben", other: `${count} angegeben` }),
  tapeTrust: "Auf der Haut oder knapp darüber gemessen. Dem Maßband wird auf 1 cm genau vertraut.",
  words: {
    female: "Frau",
    male: "Mann",
    with: (who, height) => `${who}, ${height}`,
  },
  todo: {
    picture: "Bild wählen",
    gender: "Weiblich oder männlich wählen",
    height: "Körperhöhe korrigieren",
    weight: "Gewicht korrigieren",
    tape: "Ein Maß korrigieren",
    points: "Mehr Punkte klicken",
  },
};
