// How a picture gets in.
import { batch, signal } from "@preact/signals";
import { getAsked, getFile } from "../api/calls";
import { askedOfView } from "../api/fits";
import type { Fit } from "../api/fits";
import type { FitOptions } from "../api/types";
import { change, isCorrecting, oneOf, points, useMask, usePicture } from "../draft/draft";
import { openPicture } from "../draft/chosen";
import { shownPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { forgetProposal, proposeFirst } from "../draft/proposing";
import { loadDraft } from "../draft/request";
import { messages } from "../messages";
import { skipRest } from "../points/placed";
import { PREPARE_ADDRESS, go, isMeasuring } from "../route";

export const openProblem = signal<string | null>(null);

export async function openFile(
  file: Blob,
  name = file instanceof File ? file.name : messages.start.picture,
  beginning: "proposed" | "open" = "proposed",
): Promise<void> {
  await open(async () => {
    const opened = await openPicture(file, name);
    return () => {
      use(opened);
      if (beginning === "proposed") proposeFirst();
    };
  });
}

/** A sample by the name of its files, with its points. */
export async function trySample(name: string): Promise<void> {
  await open(async () => {
    const [opened, asked] = await Promise.all([
      fetch(`/page/${name}.jpg`)
        .then((answer) => answer.blob())
        .then((file) => openPicture(file, `${name}.jpg`)),
      fetch(`/page/${name}.json`).then((answer) => answer.json() as Promise<FitOptions>),
    ]);
    return () => {
      use(opened);
      loadDraft(asked);
      // Its points are all there are: none is asked for.
      change(skipRest(points.value));
    };
  });
}

/** One of a fit's pictures with its mask and what was asked of it, to be changed and sent again. */
export async function openAgain(fit: Fit, number: number, picture: Picture): Promise<void> {
  const { mask: maskPath } = fit.pictures[number]!;
  const [asked, mask, opened] = await Promise.all([
    getAsked(fit),
    maskPath ? getFile(maskPath).then((file) => shownPicture(file, messages.start.maskOfFit)) : null,
    // Its own: the fit's view lets go of the one it shows.
    shownPicture(picture.file, picture.name, picture.shown),
  ]);
  begin(() => {
    use(opened);
    oneOf.value = fit.pictures.length > 1 ? { kind: fit.kind, id: fit.id, number } : null;
    loadDraft(askedOfView(asked, number));
    useMask(mask);
    isCorrecting.value = true;
    // The service proposed all of them.
    if (Object.keys(points.value.placed).length === 0) proposeFirst();
  });
}

export function listenForPaste(): void {
  addEventListener("paste", (event) => {
    if (isMeasuring.value) return;
    const file = [...(event.clipboardData?.files ?? [])].find((each) => each.type.startsWith("image/"));
    if (file) void openFile(file, messages.start.pasted);
  });
}

/** So many times something was opened: what comes late does not take the place of what was opened after it. */
let openings = 0;

async function open(prepared: () => Promise<() => void>): Promise<void> {
  const opening = ++openings;
  openProblem.value = null;
  try {
    const change = await prepared();
    if (opening === openings) begin(change);
  } catch (error) {
    if (opening === openings) openProblem.value = error instanceof Error ? error.message : String(error);
  }
}

/** All of a draft at once, so that nothing is typed into it before it is whole. */
function begin(change: () => void): void {
  batch(() => {
    openProblem.value = null;
    change();
    go(PREPARE_ADDRESS);
  });
  // A sample that was tapped lies far down on a phone, and its picture is at the top.
  scrollTo(0, 0);
}

function use(picture: Picture): void {
  forgetProposal();
  usePicture(picture);
}

/** Nothing of the person or the picture is left. */
export function discard(): void {
  batch(() => {
    openProblem.value = null;
    forgetProposal();
    usePicture(null);
  });
}
