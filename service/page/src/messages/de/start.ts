// The start.
import type { Messages } from "../catalogue";

export const start: Messages["start"] = {
  title: "Ein Körper in 3D und seine Maße, aus einem Bild oder zweien",
  accuracy: (least, most, people) =>
    `Von vorn und von der Seite weichen die Umfänge von Brust, Taille und Hüfte im Mittel um ${least} bis ${most} ab, auf gerenderten Bildern von ${people} Personen, auf die nichts abgestimmt wurde.`,
  figures: "Alle Zahlen",
  choose: "Bild wählen",
  take: "Foto machen oder Bild wählen",
  goOn: { with: (picture) => `Weiter mit ${picture}`, discard: "Verwerfen" },
  ways: {
    one: { title: "Ein Bild", text: "Ein Foto oder Gemälde, in beliebiger Haltung." },
    two: { title: "Von vorn und von der Seite", text: "Zwei Fotos einer stehenden Person: misst am genauesten.", go: "Zwei Bilder wählen" },
  },
  otherWays: "Sie können ein Bild auch hierher ziehen oder einfügen.",
  kept: {
    erased: (duration) => `Bilder gehen nur an diesen Dienst. Sie werden mit ihren Ergebnissen ${duration} nach der letzten Verwendung gelöscht.`,
    untold: "Bilder gehen nur an diesen Dienst. Sie werden mit ihren Ergebnissen einige Zeit nach der letzten Verwendung gelöscht.",
    draft: "Was Sie geklickt und eingegeben haben, bleibt mit dem Bild auch in diesem Browser, bis Sie es absenden.",
  },
  turning: {
    label: "Der Körper aus dem ersten Beispiel von allen Seiten; drücken hält ihn an",
    caption: "Gefunden im ersten Beispiel",
    hold: "Drücken hält ihn an",
  },
  samples: {
    title: "Kein Bild zur Hand? Probieren Sie eines von diesen",
    labels: { sample: "Entspannt", woman: "Aufrecht", arm_across: "Arm vor dem Bauch" },
    pictured: {
      sample: "Ein Mann steht entspannt, eine Hand auf der Hüfte, von links beleuchtet",
      woman: "Eine Frau steht aufrecht, Arme und Beine abgespreizt",
      arm_across: "Ein schwerer Mann hält einen Arm vor den Bauch",
    },
  },
  notShown: (name) => `${name} ist kein Bild, das dieser Browser zeigen kann. Nehmen Sie JPEG, PNG oder WebP.`,
  heic: (name) =>
    `${name} ist ein HEIC-Bild, das weder dieser Browser noch dieser Dienst zeigen kann. Wählen Sie auf dem iPhone Einstellungen > Kamera > Formate > Maximale Kompatibilität, dann nimmt es JPEG auf, oder geben Sie dieses Bild als JPEG weiter.`,
  cutOff: (name) => `${name} ist abgeschnitten: Das Ende fehlt. Wählen Sie die vollständige Datei, oder speichern Sie sie neu.`,
  tooSmall: (name, size, least) => `${name} hat ${size} Pixel; nötig sind mindestens ${least} je Seite.`,
  tooNarrow: (name, size, ratio) => `${name} hat ${size} Pixel. Schneiden Sie es so zu, dass es weniger als ${ratio}-mal so lang wie breit ist.`,
  notConverted: "Das Bild lässt sich nicht umwandeln.",
  picture: "Bild",
  pasted: "eingefügtes Bild",
  maskOfFit: "Maske jener Auswertung",
};
