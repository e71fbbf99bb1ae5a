// How far measurements err.
export const accuracy = {
  title: "How good the measurements are",
  lead: (people: string) =>
    `Mean absolute errors, in pictures of ${people} people that nothing was tuned on. The pictures are rendered, so that the truth is known: bodies of another make, drawn by another program.`,
  columns: { chest: "Chest", hip: "Hip", weight: "Weight" },
  given: "given",
  pair: {
    caption: "Upright for measuring, as a phone takes it, with the height known",
    waist: "Smallest waist",
    rows: {
      front: "Front alone",
      frontAndSide: "Front and side",
      fourPictures: "Four pictures",
      weightGiven: "Front and side, weight known",
    },
  },
  single: {
    caption: "One picture in any stance, with points clicked and the height known",
    waist: "Waist at the navel",
    rows: {
      outline: "By the outline alone",
      shading: "By outline and shading",
      weightGiven: "By both, weight known",
    },
  },
  loose: (error: string) => `Loose clothes hide the body: waists are then ${error} off on average.`,
  limits: "Every result has an interval for each measurement. This is not a medical device.",
  back: "Choose a picture",
} as const;
