// What can be made of a finished fit: one module a kind.
import type { ProductKind } from "../../api/types";
import { FIRST_ANIMATION, animation } from "./animation";
import { FIRST_CARICATURE, caricature } from "./caricature";
import { composition } from "./composition";
import { FIRST_POSE, pose } from "./pose";
import { FIRST_SIZE, size } from "./size";
import { FIRST_TEXTURE, texture } from "./texture";
import type { Kind } from "./kind";

/** What is chosen of every kind, whichever is shown. */
export const FIRST_WISHES = { ...FIRST_POSE, ...FIRST_ANIMATION, ...FIRST_TEXTURE, ...FIRST_CARICATURE, ...FIRST_SIZE };
export type Wishes = typeof FIRST_WISHES;

/** In the order they are offered. */
export const KINDS: Readonly<Record<ProductKind, Kind<Wishes>>> = {
  print: { request: () => ({ kind: "print" }) },
  animation,
  pose,
  texture,
  caricature,
  size,
  composition,
};
