// Limbs that point the other way: shown first, then measured again.
export const limbs = {
  title: "Limbs: toward you or away",
  help: "One picture hardly tells whether a limb comes toward the camera or points away. Click a limb on the body, or choose it here, to turn it. Then measure again.",
  facings: { toward: "toward you", away: "away from you" },
  isOpen: "uncertain",
  /** Of a limb that was turned. */
  now: (facing: string) => `now ${facing}`,
  hover: (limb: string, facing: string) => `${limb}: points ${facing}. Click to turn it.`,
  hoverBack: (limb: string, facing: string) => `${limb}: turned, points ${facing}. Click to take it back.`,
  badge: "Preview, not measured yet",
  preview: (limbs: string) => `Preview: ${limbs}. The measurements are still those from before.`,
  turned: { toward: (limb: string) => `${limb} toward you`, away: (limb: string) => `${limb} away from you` },
  takeBack: "Take back",
  takenBack: "The body is shown as it was found.",
  again: "Measure again",
} as const;
