// The head, dialogs, the history, and what appears everywhere.
import { plural } from "./figures";

export const frame = {
  description: "Your measurements and your body in 3D, from one photo.",
  start: "Maquette: start",
  fresh: "New",
  history: "History",
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
    title: "History",
    none: "Nothing yet.",
    takeOff: (name: string) => `Remove ${name} from the history`,
    note: "This history is kept in this browser alone. The service erases results after a while, or at once when you delete them.",
    waist: (girth: string) => `Waist ${girth}`,
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
    height: (height: string) => `A height of ${height} is assumed. Give the real one: all else scales with it.`,
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
