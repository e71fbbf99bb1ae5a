// Whether the clothes look loose, by the service's check: it is proposed, never switched.
import { effect, signal } from "@preact/signals";
import { checkCapture } from "../api/calls";
import { clothing, picture, uploaded } from "../draft/draft";
import type { Picture } from "../draft/picture";
import { canPropose, isProposing, proposal } from "../draft/proposing";
import { proposedMask } from "./proposed";

const LOOSE = "clothes-loose";

/** The picture whose clothes look loose. */
const found = signal<Picture | null>(null);

export function looksLoose(): boolean {
  return found.value !== null && found.value === picture.value && clothing.value === "tight";
}

/** Check every picture once its mask is there: points come first. */
export function startCheckingClothes(): void {
  effect(() => {
    const shown = picture.value;
    const kept = uploaded.value;
    if (!shown || !kept || !canPropose.value || isProposing.value || proposedMask.value === null) return undefined;
    const leaving = new AbortController();
    const person = proposal.value?.person ?? null;
    checkCapture({ image_id: kept.id, person, points: {}, format: "named" }, leaving.signal).then(
      ({ findings }) => (found.value = findings.some(({ code }) => code === LOOSE) ? shown : null),
      // Without an answer nothing is asked; the choice is among what the fit goes by.
      () => undefined,
    );
    return () => leaving.abort();
  });
}
