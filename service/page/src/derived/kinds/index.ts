// What can be made of a finished fit, as a person reads it: one module a kind.
import type { DerivationKind } from "../../api/types";
import { FIRST_ANIMATION, animation } from "./animation";
import { FIRST_CARICATURE, caricature } from "./caricature";
import { FIRST_COMBINED, combined } from "./combined";
import { FIRST_FIGURE, figure } from "./figure";
import { FIRST_POSE, pose } from "./pose";
import { report } from "./report";
import { FIRST_TEXTURE, texture } from "./texture";
import type { Kind } from "./kind";

/** What is chosen of every kind, whichever is shown. */
export const FIRST_WISHES = {
  ...FIRST_FIGURE,
  ...FIRST_POSE,
  ...FIRST_ANIMATION,
  ...FIRST_TEXTURE,
  ...FIRST_CARICATURE,
  ...FIRST_COMBINED,
};
export type Wishes = typeof FIRST_WISHES;

/** What the API offers to programs alone. */
type Unoffered = "size" | "body_composition" | "change";
export type OfferedKind = Exclude<DerivationKind, Unoffered>;

/** In the order they are offered. */
export const KINDS: Readonly<Record<OfferedKind, Kind<Wishes>>> = {
  report,
  figure,
  pose,
  animation,
  texture,
  caricature,
  combined,
};

/** Of a kind that this page may not know yet, too. */
export function kindOf(kind: string): Kind<Wishes> | null {
  return KINDS[kind as OfferedKind] ?? null;
}

export function kindLabel(kind: string): string {
  return kindOf(kind)?.label ?? (kind.charAt(0).toUpperCase() + kind.slice(1)).replaceAll("_", " ");
}
