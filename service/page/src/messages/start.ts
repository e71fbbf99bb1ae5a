// The start.
export const start = {
  title: "A body in 3D and its measurements, from one picture or two",
  accuracy: (least: string, most: string, people: string) =>
    `From front and side, girths of chest, waist and hip are ${least} to ${most} off on average, in rendered pictures of ${people} people it was never tuned on.`,
  figures: "All figures",
  choose: "Choose a picture",
  take: "Take or choose a picture",
  goOn: { with: (picture: string) => `Go on with ${picture}`, discard: "Discard it" },
  ways: {
    one: { title: "One picture", text: "A photograph or painting, in any stance." },
    two: { title: "Front and side", text: "Two photographs of a person standing: measures best.", go: "Take or choose two" },
  },
  otherWays: "You can also drop a picture here, or paste one.",
  kept: {
    erased: (duration: string) => `Pictures go to this service and nowhere else. They are erased, with their results, ${duration} after the last use.`,
    untold: "Pictures go to this service and nowhere else. They are erased, with their results, some time after the last use.",
    draft: "Until you send it, your picture and what you typed stay in this browser.",
  },
  turning: {
    label: "The body found in the first sample, seen from all sides; press to hold it still",
    caption: "Found in the first sample",
    hold: "Press to hold it still",
  },
  samples: {
    title: "No picture at hand? Try one of these",
    labels: { sample: "At ease", woman: "Upright", arm_across: "An arm across" },
    pictured: {
      sample: "A man stands at ease, a hand on his hip, lit from the left",
      woman: "A woman stands upright, arms and legs apart",
      arm_across: "A heavy man holds an arm before his belly",
    },
  },
  notShown: (name: string) => `${name} is not a picture this browser can show. Take a JPEG, PNG or WebP.`,
  heic: (name: string) =>
    `${name} is a HEIC picture, which neither this browser nor this service can show. On the iPhone choose Settings > Camera > Formats > Most Compatible for JPEG pictures, or share this one as a JPEG.`,
  cutOff: (name: string) => `${name} is cut off: its end is missing. Choose the whole file, or save it anew.`,
  tooSmall: (name: string, size: string, least: string) => `${name} has ${size} pixels; at least ${least} a side are needed.`,
  tooNarrow: (name: string, size: string, ratio: string) =>
    `${name} has ${size} pixels. Crop it to less than ${ratio} times as long as wide.`,
  notConverted: "The picture cannot be converted.",
  picture: "picture",
  pasted: "pasted picture",
  maskOfFit: "the mask of that fit",
} as const;
