// The mask that is proposed with the points, or by itself where somebody else placed them.
import { computed, effect, signal } from "@preact/signals";
import { proposePoints } from "../api/calls";
import { picture, points, uploaded } from "../draft/draft";
import type { Picture } from "../draft/picture";
import { canPropose, isProposing, proposal, proposalProblem } from "../draft/proposing";

/** Asked for without points; of this picture. */
const asked = signal<{ readonly picture: Picture; readonly mask: string | null } | null>(null);

export const maskWithoutPoints = computed<string | null>(() => (asked.value?.picture === picture.value ? (asked.value?.mask ?? null) : null));

/** A grey PNG, base64; null while there is none. */
export const proposedMask = computed<string | null>(() => {
  if (proposal.value) return proposal.value.mask ?? null;
  return maskWithoutPoints.value;
});

export function restoreMaskWithoutPoints(picture: Picture, mask: string | null): void {
  if (mask !== null) asked.value = { picture, mask };
}

/** Ask for a mask wherever points come without one. */
export function startProposingMasks(): void {
  effect(() => {
    const shown = picture.value;
    const kept = uploaded.value;
    if (!shown || !kept || !canPropose.value || isProposing.value || proposal.value || proposalProblem.value) return undefined;
    if (asked.peek()?.picture === shown) return undefined;
    const leaving = new AbortController();
    proposePoints({ image_id: kept.id, person: points.peek().person, mask: true }, leaving.signal).then(
      ({ mask }) => (asked.value = { picture: shown, mask: mask ?? null }),
      // The fit cuts the person out by itself: a mask that cannot be shown is no fault of the draft.
      () => undefined,
    );
    return () => leaving.abort();
  });
}
