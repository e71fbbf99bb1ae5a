// The draft outlives the page: it is kept in this browser until its fit is accepted, or it is discarded.
import { batch, computed, effect, signal } from "@preact/signals";
import { restoreStrokes, strokes } from "../mask/edits";
import { maskWithoutPoints, restoreMaskWithoutPoints } from "../mask/proposed";
import type { Stroke } from "../mask/strokes";
import type { Points } from "../points/placed";
import { begin } from "../points/timeline";
import * as draft from "./draft";
import type { Person } from "./person";
import { shownPicture } from "./picture";
import type { Picture } from "./picture";
import { proposalSoFar, restoreProposal } from "./proposing";
import type { ProposalSoFar } from "./proposing";
import { eraseStored, storeDraft, storeRest, storedDraft } from "./storage";
import type { StoredDraft, StoredRest } from "./storage";

/** Whether it is not known yet if there is one. */
export const isRestoring = signal(true);

interface Rest {
  readonly oneOf: typeof draft.oneOf.value;
  readonly points: Points;
  readonly person: Person;
  readonly focalLength: typeof draft.focalLength.value;
  readonly light: typeof draft.light.value;
  readonly surroundings: typeof draft.surroundings.value;
  readonly clothing: typeof draft.clothing.value;
  readonly facing: typeof draft.facing.value;
  readonly cues: typeof draft.cues.value;
  readonly seenFromBehind: boolean;
  readonly mask: { readonly name: string; readonly file: Blob } | null;
  readonly proposal: ProposalSoFar;
  readonly maskWithoutPoints: string | null;
  readonly strokes: readonly Stroke[];
}

const rest = computed<Rest>(() => ({
  oneOf: draft.oneOf.value,
  points: draft.points.value,
  person: draft.person.value,
  focalLength: draft.focalLength.value,
  light: draft.light.value,
  surroundings: draft.surroundings.value,
  clothing: draft.clothing.value,
  facing: draft.facing.value,
  cues: draft.cues.value,
  seenFromBehind: draft.seenFromBehind.value,
  mask: draft.mask.value && { name: draft.mask.value.name, file: draft.mask.value.file },
  proposal: proposalSoFar.value,
  maskWithoutPoints: maskWithoutPoints.value,
  strokes: strokes.value.present,
}));

/** Take up the draft of an earlier visit, and keep every one from then on. */
export async function startLasting(): Promise<void> {
  let id = "";
  let kept: Picture | null = null;
  try {
    const found = await storedDraft();
    // Whoever was quicker has begun another.
    if (found && draft.picture.value === null) {
      kept = await restored(found);
      id = found.id;
    }
  } catch {
    // What cannot be shown any more is replaced by the next draft.
  }
  isRestoring.value = false;
  effect(() => {
    const shown = draft.picture.value;
    if (shown === kept) return;
    kept = shown;
    if (shown) {
      // Not of crypto: pages that are not served securely have none that makes ids.
      id = `${Date.now()} ${Math.random()}`;
      const { name, file, shown: seen } = shown;
      // With what is said of it already: it is never kept without.
      void storeDraft(id, { picture: { name, file, shown: seen }, rest: stored(rest.peek()) });
    } else {
      void eraseStored(id);
    }
  });
  let isWriting = false;
  let isLate = false;
  const write = async () => {
    isLate = isWriting;
    if (isWriting) return;
    isWriting = true;
    await storeRest(id, stored(rest.peek()));
    isWriting = false;
    if (isLate) await write();
  };
  effect(() => {
    void rest.value;
    if (draft.picture.peek()) void write();
  });
}

function stored(rest: Rest): StoredRest {
  return rest as unknown as StoredRest;
}

async function restored({ picture, rest: said }: StoredDraft): Promise<Picture | null> {
  const rest = said as unknown as Rest;
  const [opened, mask] = await Promise.all([
    shownPicture(picture.file, picture.name, picture.shown),
    rest.mask && shownPicture(rest.mask.file, rest.mask.name),
  ]);
  if (draft.picture.value !== null) return null;
  batch(() => {
    draft.usePicture(opened);
    // Earlier versions of this page kept none.
    draft.oneOf.value = rest.oneOf ?? null;
    draft.timeline.value = begin(rest.points);
    draft.person.value = rest.person;
    draft.focalLength.value = rest.focalLength;
    draft.light.value = rest.light;
    draft.surroundings.value = rest.surroundings;
    draft.clothing.value = rest.clothing;
    draft.facing.value = rest.facing;
    draft.cues.value = rest.cues;
    draft.seenFromBehind.value = rest.seenFromBehind;
    draft.useMask(mask);
    restoreProposal(rest.proposal);
    restoreMaskWithoutPoints(opened, rest.maskWithoutPoints);
    draft.isAsleep.value = true;
  });
  // Not before: what brushes did is forgotten whenever the mask below them is another.
  restoreStrokes(rest.strokes);
  return opened;
}
