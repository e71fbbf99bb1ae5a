// What can be made of a finished fit, as a person reads it: one module a kind.
import type { DerivationKind } from "../../api/types";
import { plainName } from "../../messages/words";
import { capitalised } from "../../messages/figures";
import { messages } from "../../messages";
import { FIRST_ANIMATION, animation } from "./animation";
import { FIRST_CARICATURE, caricature } from "./caricature";
import { FIRST_COMBINED, combined } from "./combined";
import { FIRST_FIGURE, figure } from "./figure";
import { FIRST_POSE, pose } from "./pose";
import { FIRST_REPORT, report } from "./report";
import { FIRST_SIZE, size } from "./size";
import { FIRST_TEXTURE, texture } from "./texture";
import type { Kind } from "./kind";

/** What is chosen of every kind, whichever is shown. */
export const FIRST_WISHES = {
  ...FIRST_REPORT,
  ...FIRST_FIGURE,
  ...FIRST_POSE,
  ...FIRST_ANIMATION,
  ...FIRST_TEXTURE,
  ...FIRST_CARICATURE,
  ...FIRST_COMBINED,
  ...FIRST_SIZE,
};
export type Wishes = typeof FIRST_WISHES;

/** What the API offers to programs alone. */
type Unoffered = "body_composition" | "change";
export type OfferedKind = Exclude<DerivationKind, Unoffered>;

/** In the order they are offered. */
export const KINDS: Readonly<Record<OfferedKind, Kind<Wishes>>> = {
  report,
  size,
  figure,
  pose,
  animation,
  texture,
  caricature,
  combined,
};

/** Of a kind that this page may not know yet, too. */
export function kindOf(kind: string): Kind<Wishes> | null {
  return isOffered(kind) ? KINDS[kind] : null;
}

export function kindLabel(kind: string): string {
  return isOffered(kind) ? messages.derived.kinds[kind].label : capitalised(plainName(kind));
}

/** As it stands within a sentence. */
export function wordInSentence(kind: string): string {
  return isOffered(kind) ? messages.derived.kinds[kind].inSentence : plainName(kind);
}

function isOffered(kind: string): kind is OfferedKind {
  return Object.hasOwn(KINDS, kind);
}
