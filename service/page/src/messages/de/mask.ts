// The mask before the fit: how it is shown, and its brushes.
import type { Messages } from "../catalogue";

export const mask: Messages["mask"] = {
  title: "Maske der Person",
  proposed: "vorgeschlagen",
  chosen: "aus einer Datei",
  edited: "bearbeitet",
  help: "Ungefähr das hält die Auswertung für die Person; den Rand verfeinert sie selbst. Bessern Sie nach, wo etwas fehlt oder etwas anderes dabei ist.",
  editedHelp: "Die Auswertung nimmt die Person genau so, wie sie bearbeitet ist.",
  preview: "Das Bild mit der Maske",
  shown: "Die Maske über dem Bild",
  edit: "Ansehen und nachbessern",
  done: "Fertig",
  reset: "Änderungen verwerfen",
  undo: "Letzten Strich zurücknehmen",
  redo: "Strich wiederholen",
  tools: "Maske",
  brush: "Pinsel",
  brushes: { add: "Hinzufügen", remove: "Wegnehmen" },
  size: "Größe",
  stage: (brush) => `Bild mit seiner Maske. Pinsel: ${brush}.`,
  keys:
    "Malen Sie durch Ziehen; mit Umschalttaste verschieben Sie das Bild. Pfeiltasten bewegen den Pinsel, mit Umschalttaste um zehn Pixel; Eingabe tupft, X wechselt den Pinsel, eckige Klammern seine Größe, Plus und Minus vergrößern und verkleinern, 0 zeigt das ganze Bild, Strg Z nimmt zurück.",
  tooLarge: "Dieser Browser kann keine Maske zeichnen, die so groß ist wie das Bild. Verwenden Sie ein kleineres Bild, oder verwerfen Sie die Änderungen.",
  loose: {
    question: "Die Kleidung sieht weit aus. Ist sie es?",
    yes: "Ja, weite Kleidung",
    said: "Die Kleidung gilt als weit.",
  },
};
