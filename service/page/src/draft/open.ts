// How pictures get in.
import { batch, signal } from "@preact/signals";
import { getAsked, getFile } from "../api/calls";
import type { Fit, FitRequest } from "../api/types";
import { messages } from "../messages";
import { PREPARE_ADDRESS, go } from "../route";
import { MOST_VIEWS, addView, beginWith, cues, isCorrecting, lookAt, newView, replaceView, views } from "./draft";
import { openPicture, shownPicture } from "./picture";
import type { Picture } from "./picture";
import { loadPerson, loadView } from "./request";

export const openProblem = signal<string | null>(null);

/** One picture, or several of one person: a draft of its own. */
export async function openFiles(files: readonly Blob[]): Promise<void> {
  await open(async () => {
    const opened = await Promise.all(files.slice(0, MOST_VIEWS).map(openFile));
    return () => beginWith(opened.map(newView));
  });
}

/** One more picture of the person. */
export async function addFile(file: Blob): Promise<void> {
  await open(async () => {
    const opened = await openFile(file);
    return () => addView(opened);
  });
}

/** Another picture in the place of the one that is looked at. */
export async function replaceFile(file: Blob): Promise<void> {
  await open(async () => {
    const opened = await openFile(file);
    return () => (views.value.length > 1 ? replaceView(opened) : beginWith([newView(opened, 0)]));
  });
}

export interface Sample {
  readonly pictures: readonly string[];
  /** The name of the request that goes with it. */
  readonly request: string;
}

/** A sample with its person and its points. */
export async function trySample({ pictures, request }: Sample): Promise<void> {
  await open(async () => {
    const [asked, ...opened] = await Promise.all([
      fetch(`/page/${request}`).then((answer) => answer.json() as Promise<FitRequest>),
      ...pictures.map((name) => fetch(`/page/${name}`).then(async (answer) => openPicture(await answer.blob(), name))),
    ]);
    return () => load(asked, opened);
  });
}

/** A fit's pictures with their masks and what was asked of them, to be changed and sent again. */
export async function openAgain(fit: Fit, number: number, pictures: readonly Picture[]): Promise<void> {
  const mask = async (path: string | null | undefined) => (path ? shownPicture(await getFile(path), messages.start.maskOfFit) : null);
  const [asked, masks, opened] = await Promise.all([
    getAsked(fit.id),
    Promise.all(pictures.map((_, at) => mask(maskOf(fit, at)))),
    // Their own: the fit's view lets go of those it shows.
    Promise.all(pictures.map(({ file, name, shown }) => shownPicture(file, name, shown))),
  ]);
  begin(() => {
    load(asked, opened);
    views.value.forEach((view, at) => (view.mask.value = masks[at] ?? null));
    lookAt(number);
    isCorrecting.value = true;
  });
}

export function listenForPaste(): void {
  addEventListener("paste", (event) => {
    const files = [...(event.clipboardData?.files ?? [])].filter((each) => each.type.startsWith("image/"));
    if (files.length > 0) void openFiles(files);
  });
}

/** Nothing of the person or the pictures is left. */
export function discard(): void {
  openProblem.value = null;
  beginWith([]);
}

function maskOf({ links }: Fit, number: number): string | undefined {
  return links.files[`views/${number}/mask`];
}

function load(asked: FitRequest, pictures: readonly Picture[]): void {
  beginWith(pictures.map(newView));
  loadPerson(asked);
  cues.value = asked.cues ?? "SES";
  views.value.forEach((view, at) => loadView(view, asked.views?.[at] ?? {}));
}

function openFile(file: Blob): Promise<Picture> {
  return openPicture(file, file instanceof File ? file.name : messages.start.picture);
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
