// How far measurements err.
import type { Messages } from "../catalogue";

export const accuracy: Messages["accuracy"] = {
  title: "Wie genau die Maße sind",
  lead: (people) =>
    `Mittlere absolute Fehler über ${people} Personen, auf die nichts abgestimmt wurde. Ihre Bilder sind gerendert, damit die Wahrheit bekannt ist: Körper anderer Herkunft, von einem anderen Programm gezeichnet.`,
  columns: { chest: "Brust", hip: "Hüfte", weight: "Gewicht" },
  given: "bekannt",
  pair: {
    caption: "Aufrecht zum Messen, wie ein Telefon es aufnimmt, Körperhöhe bekannt",
    waist: "Schmalste Taille",
    rows: {
      front: "Nur von vorn",
      frontAndSide: "Von vorn und von der Seite",
      fourPictures: "Vier Bilder",
      weightGiven: "Von vorn und von der Seite, Gewicht bekannt",
    },
  },
  single: {
    caption: "Ein Bild in beliebiger Haltung, Punkte geklickt, Körperhöhe bekannt",
    waist: "Taille am Nabel",
    rows: {
      outline: "Nur nach dem Umriss",
      shading: "Nach Umriss und Schattierung",
      weightGiven: "Nach beidem, Gewicht bekannt",
    },
  },
  loose: (error) => `Weite Kleidung verbirgt den Körper: Taillen weichen dann im Mittel um ${error} ab.`,
  limits: "Jedes Ergebnis nennt zu jedem Maß ein Intervall. Dies ist kein Medizinprodukt.",
  back: "Bild wählen",
};
