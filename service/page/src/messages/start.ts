// The start.
export const start = {
  title: "Your measurements and your body in 3D, from one photo",
  accuracy: (most: string, people: string) =>
    `From front and side, chest, waist and hip are typically within ${most} (tested on ${people} rendered people).`,
  figures: "All\u00a0figures",
  choose: "Choose a picture",
  take: "Take or choose a picture",
  goOn: { with: (picture: string) => `Continue with ${picture}`, discard: "Discard" },
  ways: "One photo in any pose will do. Two of a person who stands, from the front and from the side, measure best.",
  otherWays: "You can also drop a picture here, or paste one.",
  kept: {
    erased: (duration: string) => `Pictures go to this service and nowhere else. They are erased, with their results, ${duration} after the last use.`,
    untold: "Pictures go to this service and nowhere else. They are erased, with their results, some time after the last use.",
  },
  turning: {
    label: "The body found in the first sample, seen from all sides; press to pause",
    caption: "Found in the first sample",
    hold: "Press to pause",
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
  maskOfFit: "the mask of that result",
} as const;
