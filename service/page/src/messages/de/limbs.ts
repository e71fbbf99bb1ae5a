import type { Messages } from "../catalogue";

export const limbs: Messages["limbs"] = {
  title: "Richtung der Arme und Beine",
  help: "Aus einem Bild ist kaum zu erkennen, ob ein Arm oder Bein zur Kamera zeigt oder von ihr weg. Klicken Sie am Körper darauf oder wählen Sie hier, dann wird es andersherum gezeigt. Werten Sie danach erneut aus.",
  facings: { toward: "zu Ihnen hin", away: "von Ihnen weg" },
  isOpen: "unsicher",
  now: (facing) => `jetzt ${facing}`,
  hover: (limb, facing) => `${limb}: zeigt ${facing}. Ein Klick dreht die Richtung um.`,
  hoverBack: (limb, facing) => `${limb}: umgedreht, zeigt ${facing}. Ein Klick nimmt es zurück.`,
  badge: "Vorschau, noch nicht ausgewertet",
  preview: (limbs) => `Vorschau: ${limbs}. Die Maße sind noch die der Auswertung.`,
  turned: { toward: (limb) => `${limb} zu Ihnen hin`, away: (limb) => `${limb} von Ihnen weg` },
  takeBack: "Zurücknehmen",
  takenBack: "Der Körper wird wieder so gezeigt, wie er ausgewertet wurde.",
  again: "Erneut auswerten",
};
