// The start.
export const start = {
  title: "A body in 3D and its measurements, from one picture or two",
  accuracy: (least: string, most: string, people: string) =>
    `From front and side, girths of chest, waist and hip are ${least} to ${most} off on average, in rendered pictures of ${people} people it was never tuned on.`,
  figures: "All figures",
  choose: "Choose a picture",
  take: "Take or choose a picture",
  goOn: { with: (picture: string) => `Go on with ${picture}`, discard: "Discard it" },
  ways: "One picture in any stance; or two of a person who stands, from the front and from the side, which measures best.",
  otherWays: "You can also drop a picture here, or paste one.",
  kept: {
    erased: (duration: string) => `Pictures go to this service and nowhere else. They are erased, with their results, ${duration} after the last use.`,
    untold: "Pictures go to this service and nowhere else. They are erased, with their results, some time after the last use.",
  },
  turning: {
    label: "The body found in the first sample, seen from all sides; press to hold it still",
    caption: "Found in the first sample",
    hold: "Press to hold it still",
  },
  samples: {
    title: "No picture at hand? Try one of these",
    labels: { sample: "At ease", woman: "Upright", arm_across: "An arm across", pair: "Front and side" },
    pictured: {
      sample: "A man stands at ease, a hand on his hip, lit from the left",
      woman: "A woman stands upright, arms and legs apart",
      arm_across: "A heavy man holds an arm before his belly",
      pair: "A small woman from the front; another picture shows her side",
    },
  },
  notShown: (name: string) => `${name} is not a picture this browser can show. Take a JPEG, PNG or WebP.`,
  picture: "picture",
  maskOfFit: "the mask of that fit",
} as const;
