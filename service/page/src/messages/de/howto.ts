// Good pictures and bad ones, side by side: captions, within a sentence.
import type { Messages } from "../catalogue";

export const howto: Messages["howto"] = {
  title: "Gute und schlechte Bilder",
  good: (what) => `Gut: ${what}`,
  bad: (what) => `Schlecht: ${what}`,
  tiles: {
    front: { what: "von vorn", remedy: "Arme deutlich vom Körper weg, Füße auseinander." },
    armsForward: { what: "von der Seite, Arme vorn", remedy: "Arme waagerecht, Füße zusammen." },
    armsHanging: { what: "von der Seite, Arme hängend", remedy: "Arme locker, Füße zusammen." },
    "cut-off": { what: "Füße abgeschnitten", remedy: "Lassen Sie Platz über dem Kopf und unter den Füßen." },
    "person-too-small": { what: "zu weit weg", remedy: "Gehen Sie näher: zwei bis drei Meter." },
    "picture-too-small": { what: "nur eine Vorschau", remedy: "Senden Sie das Bild, wie die Kamera es aufnahm." },
    "camera-too-near": { what: "zu nah", remedy: "Gehen Sie zurück, und meiden Sie das Weitwinkel." },
    "camera-rolled": { what: "Kamera schief", remedy: "Halten Sie das Telefon gerade." },
    "other-view": { what: "halb weggedreht", remedy: "Ganz zur Kamera, oder eine Vierteldrehung." },
    "arms-against-trunk": { what: "Arme am Körper", remedy: "Zwischen Armen und Körper soll die Wand zu sehen sein." },
    "clothes-loose": { what: "weite Kleidung", remedy: "Tragen Sie enge." },
    blurred: { what: "unscharf", remedy: "Stellen Sie das Telefon ab, und stellen Sie scharf." },
    "too-dark": { what: "zu dunkel", remedy: "Mehr Licht, von der Seite der Kamera." },
    "too-bright": { what: "zu hell", remedy: "Heraus aus dem grellen Licht." },
    "several-people": { what: "noch jemand", remedy: "Nur eine Person im Bild." },
  },
};
