// The picture that is clicked on.
import type { Messages } from "../catalogue";
import { plural } from "../figures";

export const stage: Messages["stage"] = {
  label: (state) => `Bild zum Anklicken. ${state}`,
  next: (point) => `Als Nächstes: ${point}.`,
  allPlaced: "Alle Punkte sind gesetzt.",
  allProposed: "Alle Punkte sind vorgeschlagen.",
  placed: (point, then) => `${point} gesetzt. ${then}`,
  maskBorder: "Der Rand der Maske",
  takeBack: "Letzte Änderung zurücknehmen",
  zoomOut: "Verkleinern",
  whole: "Ganzes Bild zeigen",
  zoomIn: "Vergrößern",
  tools: "Bild",
  full: "Ganzer Bildschirm",
  leaveFull: "Ganzen Bildschirm verlassen",
  hidden: (point) => `Von etwas verdeckt: ${point}`,
  skip: (point) => `Überspringen: ${point}`,
  enough: "Genug Punkte",
  keys:
    "Die Pfeiltasten bewegen den gewählten Punkt, oder das Fadenkreuz, wenn keiner gewählt ist; mit der Umschalttaste um zehn Pixel. Die Eingabetaste setzt den nächsten Punkt an das Fadenkreuz, Escape hebt die Wahl auf, S überspringt, H markiert als verdeckt, Entfernen löscht, Plus und Minus vergrößern und verkleinern, 0 zeigt das ganze Bild, Strg Z macht rückgängig.",
  asked: (point) => `${point}?`,
  proposing: "Punkte werden vorgeschlagen …",
  nobody: "In diesem Bild wurde niemand gefunden. Klicken Sie die Punkte selbst.",
  several: (count) => `${count} Personen wurden gefunden. Tippen Sie auf die, die Sie meinen.`,
  severalFound: (count) => `${count} Personen wurden gefunden.`,
  proposed: (count) => plural(count, { one: "Ein Punkt ist vorgeschlagen.", other: `${count} Punkte sind vorgeschlagen.` }),
  lookAt: (points) => `Sehen Sie sich diese an: ${points}.`,
};
