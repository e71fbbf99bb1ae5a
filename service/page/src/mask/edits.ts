// The mask of a picture: proposed or chosen, and what brushes did to it.
import { computed, effect, signal } from "@preact/signals";
import { current, strokes } from "../draft/draft";
import type { DraftView } from "../draft/draft";
import { messages } from "../messages";
import { advance } from "../points/timeline";
import { drawnMask, maskFile, shownScale } from "./canvas";
import type { DrawnMask } from "./canvas";
import type { Stroke } from "./strokes";

const NO_STROKES: readonly Stroke[] = [];

export const isEdited = computed(() => current.value !== null && strokes.value.present.length > 0);
export const isEditing = signal(false);
/** The mask as it is shown; null while there is none. */
export const shownMask = signal<DrawnMask | null>(null);

/** What brushes begin with, of the picture that is looked at. */
const base = signal<HTMLImageElement | null>(null);

export function addStroke(stroke: Stroke): void {
  strokes.value = advance(strokes.value, [...strokes.value.present, stroke]);
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
  const source = computed(() => current.value && sourceOf(current.value));
  effect(() => {
    const url = source.value;
    base.value = null;
    isEditing.value = false;
    if (url === null) return;
    opened(url).then(
      (image) => {
        if (source.peek() === url) base.value = image;
      },
      // A file that the browser does not show is sent as it is.
      () => undefined,
    );
  });
  effect(() => {
    const view = current.value;
    const image = base.value;
    shownMask.value = view && image ? drawnMask(image, strokes.value.present, view.picture, shownScale(view.picture)) : null;
  });
}

/** The file that a fit is sent: a mask that was chosen or edited; null leaves it to the fit. */
export async function maskToSend(view: DraftView): Promise<Blob | null> {
  const drawn = view.strokes.value.present;
  const url = sourceOf(view);
  if (drawn.length === 0 || url === null) return view.mask.value?.file ?? null;
  const file = await maskFile(drawnMask(await opened(url), drawn, view.picture, 1));
  if (!file) throw new Error(messages.mask.tooLarge);
  return file;
}

function sourceOf({ mask, proposal }: DraftView): string | null {
  const proposed = proposal.value?.mask;
  return mask.value?.url ?? (proposed ? `data:image/png;base64,${proposed}` : null);
}

async function opened(url: string): Promise<HTMLImageElement> {
  const image = new Image();
  image.src = url;
  await image.decode();
  return image;
}
