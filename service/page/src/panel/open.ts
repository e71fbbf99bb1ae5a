// How a picture gets in.
import { signal } from "@preact/signals";
import { getFile, getRequest } from "../api/calls";
import type { FitOptions, Job } from "../api/types";
import { change, points, useMask, usePicture } from "../draft/draft";
import { openPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { forgetProposal, proposeFirst } from "../draft/proposing";
import { loadDraft } from "../draft/request";
import { skipRest } from "../points/placed";
import { go, isMeasuring } from "../route";

export const openProblem = signal<string | null>(null);

/** Whose points there are once a picture is open. */
export type Beginning = "proposed" | "placed" | "open";

export async function openFile(
  file: Blob,
  name = file instanceof File ? file.name : "picture",
  beginning: Beginning = "proposed",
): Promise<void> {
  openProblem.value = null;
  try {
    const opened = await openPicture(file, name);
    forgetProposal();
    usePicture(opened);
    if (beginning === "proposed") proposeFirst();
    go("#/");
  } catch (error) {
    openProblem.value = error instanceof Error ? error.message : String(error);
  }
}

/** A sample by the name of its files. */
export async function trySample(name: string, beginning: Beginning): Promise<void> {
  const file = await (await fetch(`/page/${name}.jpg`)).blob();
  await openFile(file, `${name}.jpg`, beginning);
  if (beginning !== "placed") return;
  const asked = (await (await fetch(`/page/${name}.json`)).json()) as FitOptions;
  loadDraft(asked);
  // Its points are all there are: none is asked for.
  change(skipRest(points.value));
}

/** A fit's picture, mask and request, to be changed and sent again. */
export async function openAgain(picture: Picture, job: Job): Promise<void> {
  const [asked, mask] = await Promise.all([
    getRequest(job),
    job.links.mask ? getFile(job.links.mask).then((file) => openPicture(file, "the mask of that fit")) : null,
  ]);
  await openFile(picture.file, picture.name, "placed");
  loadDraft(asked);
  useMask(mask);
  // The service proposed all of them.
  if (Object.keys(points.value.placed).length === 0) proposeFirst();
}

export function listenForPaste(): void {
  addEventListener("paste", (event) => {
    if (isMeasuring.value) return;
    const file = [...(event.clipboardData?.files ?? [])].find((each) => each.type.startsWith("image/"));
    if (file) void openFile(file, "pasted picture");
  });
}
