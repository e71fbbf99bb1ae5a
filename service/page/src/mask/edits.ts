// The mask of the draft: proposed or chosen, and what brushes did to it.
import { computed, effect, signal } from "@preact/signals";
import { mask, picture } from "../draft/draft";
import { messages } from "../messages";
import { advance, begin } from "../points/timeline";
import { drawnMask, maskFile, shownScale } from "./canvas";
import type { DrawnMask } from "./canvas";
import { proposedMask } from "./proposed";
import type { Stroke } from "./strokes";

const NO_STROKES: readonly Stroke[] = [];

/** Where the file is that brushes begin with; null while there is none. */
const source = computed<string | null>(() => mask.value?.url ?? (proposedMask.value && `data:image/png;base64,${proposedMask.value}`));
const base = signal<HTMLImageElement | null>(null);

export const strokes = signal(begin<readonly Stroke[]>(NO_STROKES));
export const isEdited = computed(() => strokes.value.present.length > 0);
export const isEditing = signal(false);
/** The mask as it is shown; null while there is none. */
export const shownMask = signal<DrawnMask | null>(null);

export function addStroke(stroke: Stroke): void {
  strokes.value = advance(strokes.value, [...strokes.value.present, stroke]);
}

/** What brushes did earlier to the mask there is; there is nothing to take back. */
export function restoreStrokes(drawn: readonly Stroke[]): void {
  strokes.value = begin(drawn);
}

/** As its strokes say, without what was drawn on it since. */
export function redrawMask(): void {
  strokes.value = { ...strokes.value };
}

/** As it was proposed or chosen; that can be taken back too. */
export function resetMask(): void {
  if (isEdited.value) strokes.value = advance(strokes.value, NO_STROKES);
}

export function startMasks(): void {
  effect(() => {
    const url = source.value;
    base.value = null;
    strokes.value = begin<readonly Stroke[]>(NO_STROKES);
    isEditing.value = false;
    if (url === null) return;
    const image = new Image();
    image.src = url;
    image.decode().then(
      () => {
        if (source.peek() === url) base.value = image;
      },
      // A file that the browser does not show is sent as it is.
      () => undefined,
    );
  });
  effect(() => {
    const shown = picture.value;
    const image = base.value;
    shownMask.value = shown && image ? drawnMask(image, strokes.value.present, shown, shownScale(shown)) : null;
  });
}

/** The file that a fit is sent: a mask that was chosen or edited; null leaves it to the fit. */
export async function maskToSend(): Promise<Blob | null> {
  const shown = picture.value;
  const image = base.value;
  if (!isEdited.value || !shown || !image) return mask.value?.file ?? null;
  const file = await maskFile(drawnMask(image, strokes.value.present, shown, 1));
  if (!file) throw new Error(messages.mask.tooLarge);
  return file;
}
