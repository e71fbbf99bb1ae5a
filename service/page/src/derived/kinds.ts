// What can be made of a finished fit, as a person reads it.
import type { DerivationKind, DerivationRequest, NamedPose, TextureColours, TextureSize } from "../api/types";

/** What is chosen of every kind, whichever is shown. */
export interface Wishes {
  readonly factor: number;
  readonly pose: NamedPose;
  readonly degrees: number;
  readonly colours: TextureColours;
  readonly size: TextureSize;
  /** A BVH file; without one the body walks. */
  readonly motion: File | null;
  /** A texture of one's own, in the atlas' layout. */
  readonly texture: File | null;
  /** Other fits of the same person, by id. */
  readonly fits: readonly string[];
}

export const FIRST_WISHES: Wishes = {
  factor: 2,
  pose: "standing",
  degrees: 0,
  colours: "picture",
  size: 1024,
  motion: null,
  texture: null,
  fits: [],
};
export const FACTORS = { least: 0, most: 5, step: 0.25 } as const;
export const DEGREES = { least: -180, most: 180, step: 15 } as const;

export const POSES: readonly { value: NamedPose; label: string }[] = [
  { value: "standing", label: "Standing" },
  { value: "relaxed", label: "Relaxed" },
  { value: "walking", label: "Walking" },
  { value: "sitting", label: "Sitting" },
  { value: "arms_raised", label: "Arms raised" },
  { value: "a_pose", label: "A pose" },
  { value: "t_pose", label: "T pose" },
  { value: "rest", label: "The model’s own" },
];

/** A picture that shows what came out. */
export interface Shows {
  readonly file: string;
  readonly alt: string;
  /** The same standing still, where the file moves. */
  readonly still?: string;
  readonly caption?: string;
}

/** A file sent beside a request, by the name of its form part. */
export interface Part {
  readonly name: "bvh" | "texture";
  readonly file: File;
}

/** A body among the files that can be turned here. */
export interface Turns {
  readonly file: string;
  readonly label: string;
}

export interface Kind {
  readonly label: string;
  readonly help: string;
  readonly request: (wishes: Wishes) => DerivationRequest;
  readonly pictures: readonly Shows[];
  /** Of files that come by number, how they are shown; null of those that are no pictures. */
  readonly pictureOf?: (file: string) => Shows | null;
  readonly turns?: Turns;
  /** A file that comes along with the request, if one was chosen. */
  readonly part?: (wishes: Wishes) => Part | null;
  /** What has yet to be chosen before it can be made; null if nothing has. */
  readonly lacks?: (wishes: Wishes) => string | null;
}

/** In the order they are offered. */
export const KINDS: Readonly<Record<DerivationKind, Kind>> = {
  report: {
    label: "Report",
    help: "One page to read and to print: pictures, measurements, light.",
    request: () => ({ kind: "report" }),
    pictures: [],
  },
  figure: {
    label: "Figure",
    help: "Picture, overlay, body and a new pose side by side, as in the paper’s Fig. 10.",
    request: ({ pose, degrees }) => ({ kind: "figure", pose, degrees }),
    pictures: [{ file: "figure.png", alt: "Picture, overlay, body and new pose" }],
  },
  pose: {
    label: "Other pose",
    help: "The same body held otherwise, as a mesh.",
    request: ({ pose }) => ({ kind: "pose", pose }),
    pictures: [{ file: "pose.png", alt: "Other pose of the body" }],
    turns: { file: "body_reposed.glb", label: "The body in this pose" },
  },
  animation: {
    label: "Animation",
    help: "The body in motion: walking, or as a BVH file of motion capture says.",
    request: () => ({ kind: "animation" }),
    part: ({ motion }) => motion && { name: "bvh", file: motion },
    pictures: [{ file: "animation.webp", still: "animation.png", alt: "The body in motion" }],
  },
  texture: {
    label: "Texture",
    help: "The picture, or a texture of your own, laid on the body. What the picture does not show is made up.",
    request: ({ colours, size }) => ({ kind: "texture", colours, ...(colours === "own" ? {} : { size }) }),
    part: ({ colours, texture }) => (colours === "own" && texture ? { name: "texture", file: texture } : null),
    lacks: ({ colours, texture }) => (colours === "own" && !texture ? "Choose a texture first." : null),
    turns: { file: "body_textured.glb", label: "The textured body" },
    pictures: [
      { file: "texture.png", alt: "Texture of the body" },
      {
        file: "coverage.png",
        alt: "Where the texture comes from",
        caption: "Where it comes from: white was seen in the picture, grey is mirrored from the other side of the body, black is continued from its surroundings.",
      },
    ],
  },
  caricature: {
    label: "Caricature",
    help: "What is most unusual of this body, exaggerated; as tall as it is.",
    request: ({ factor }) => ({ kind: "caricature", factor }),
    pictures: [{ file: "caricature.png", alt: "Caricature of the body" }],
    turns: { file: "body_caricature.glb", label: "The caricature" },
  },
  combined: {
    label: "Combined body",
    help: "One body from several pictures of the same person: narrower intervals than any picture alone gives.",
    request: ({ fits }) => ({ kind: "combined", fits: [...fits] }),
    lacks: ({ fits }) => (fits.length === 0 ? "Choose at least one other fit of this person." : null),
    pictures: [{ file: "combined.png", alt: "Combined body beside this fit alone" }],
    pictureOf: (file) => {
      const number = /^overlay_(\d+)\.png$/.exec(file)?.[1];
      return number ? { file, alt: `Combined body over picture ${number}`, caption: `In picture ${number}, as posed there` } : null;
    },
    turns: { file: "body_combined.glb", label: "The combined body" },
  },
};

/** Of a kind that this page may not know yet, too. */
export function kindOf(kind: string): Kind | null {
  return KINDS[kind as DerivationKind] ?? null;
}

export function kindLabel(kind: string): string {
  return kindOf(kind)?.label ?? kind.charAt(0).toUpperCase() + kind.slice(1);
}
