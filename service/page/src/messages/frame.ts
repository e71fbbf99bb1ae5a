// The head, dialogs, the list of fits, and what appears everywhere.
import { plural } from "./figures";

export const frame = {
  description: "A body, posed and measured, from one picture and a few clicks.",
  start: "Maquette: start",
  fresh: "New",
  history: "Fits",
  documentation: "Documentation",
  lightPage: "Light page",
  darkPage: "Dark page",
  close: "Close",
  tryAgain: "Try again",
  sending: "Sending …",
  units: "Units",
  unknown: "unknown",
  key: {
    title: "This service asks for a key",
    origin: "Whoever runs the service makes keys with",
    label: "API key",
    kept: "It is kept in this tab until you close it.",
    use: "Use this key",
  },
  list: {
    title: "Fits of this browser",
    none: "None yet.",
    takeOff: (name: string) => `Take ${name} off this list`,
    note: "Only this browser knows this list. The service erases results after a while; if you delete one, at once.",
    states: {
      queued: "Waiting",
      running: "Running",
      succeeded: "Done",
      failed: "Failed",
      canceled: "Canceled",
      timed_out: "Took too long",
    },
  },
  assumed: {
    lens: (length: string) => `A lens of ${length} (as on 35 mm film) is assumed, since the picture does not name it.`,
    height: (height: string) => `A height of ${height} is assumed. Give the real one: all else follows it.`,
    points: (count: number) =>
      plural(count, {
        one: "One point was found automatically. Check it if something looks wrong.",
        other: `${count} points were found automatically. Check them if something looks wrong.`,
      }),
  },
  fields: {
    gender: "Gender",
    height_m: "Height",
    weight_kg: "Weight",
    focal_length_35mm: "Lens",
    image: "Picture",
    mask: "Mask",
    points: "Points",
    measurements: "Measurements",
    limb_facing: "Toward you or away",
    light: "Light",
    colours: "Colours",
    texture: "Texture",
    bvh: "BVH file",
    kind: "What to make",
  },
  /** Names a field before what is said of it. */
  ofField: (field: string, said: string) => `${field}: ${said}`,
} as const;
