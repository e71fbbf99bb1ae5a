// From two places to a scan, and back from a scan to the places.
import { signal } from "@preact/signals";
import { getFile, getScanRequest, submitScan, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem, Scan, ScanOfImages } from "../api/types";
import { person } from "../draft/draft";
import { personInWords } from "../draft/person";
import { describedPerson, loadPerson } from "../draft/request";
import { remember, thumbnailOf } from "../history/store";
import { MEASURE_ADDRESS, go, scanAddress } from "../route";
import { NOT_INSTALLED, faultsOf } from "./faults";
import { PLACES, PLACE_NAMES, putPicture } from "./places";
import { canPropose } from "../draft/proposing";
import { seenScan } from "./watch";

/** What is wrong with the scan as a whole. */
export const scanProblem = signal<Problem | null>(null);

/** Ask for the measurements of the person in both places. */
export async function measure(): Promise<void> {
  const { gender } = person.value;
  if (gender === null) return;
  scanProblem.value = null;
  try {
    const views = await Promise.all(PLACE_NAMES.map(async (name) => ({ view: name, points: "auto" as const, image_id: await imageOf(name) })));
    const scan = await submitScan({ ...describedPerson(gender, person.value), cues: "SES", force: false, views: views as ScanOfImages["views"] });
    opened(scan, PLACES.front.picture.value!.element);
    go(scanAddress(scan.id));
  } catch (error) {
    const problem = problemFrom(error);
    if (problem) tell(problem);
  }
}

/** A scan whose measurements are withheld, asked for once more by force. */
export async function measureByForce(scan: Scan): Promise<void> {
  const asked = await getScanRequest(scan);
  const images = await Promise.all(scan.links.views.map(async ({ image }) => uploadImage(await getFile(image), new AbortController().signal)));
  const views = asked.views.map((view, number) => ({ ...view, image_id: images[number]!.id }));
  const begun = await submitScan({ ...asked, force: true, views: views as ScanOfImages["views"] });
  seenScan(begun);
  go(scanAddress(begun.id));
}

/** Both pictures of a scan and its person, to be changed and sent again; `problem` is told where it belongs. */
export async function reopen(scan: Scan, problem: Problem | null): Promise<void> {
  const asked = await getScanRequest(scan);
  loadPerson(asked);
  for (const name of PLACE_NAMES) {
    const number = asked.views.findIndex(({ view }) => view === name);
    const links = scan.links.views[number];
    if (links) await putPicture(PLACES[name], await getFile(links.image), name);
  }
  scanProblem.value = null;
  if (problem) tell(problem);
  go(MEASURE_ADDRESS);
}

export function opened(scan: Scan, picture: HTMLImageElement): void {
  seenScan(scan);
  const name = personInWords(describedPerson(person.value.gender ?? "female", person.value), person.value.units);
  remember({ id: scan.id, name, startedAt: scan.created_at, thumbnail: thumbnailOf(picture), scan: true });
}

async function imageOf(name: (typeof PLACE_NAMES)[number]): Promise<string> {
  const { picture, uploaded } = PLACES[name];
  const kept = uploaded.value ?? (await uploadImage(picture.value!.file, new AbortController().signal));
  uploaded.value = kept;
  return kept.id;
}

function tell(problem: Problem): void {
  if (problem.code === NOT_INSTALLED) {
    canPropose.value = false;
    return;
  }
  const { views, rest } = faultsOf(problem);
  PLACE_NAMES.forEach((name, number) => {
    const fault = views.get(number) ?? null;
    PLACES[name].problem.value = fault;
    // It may have been erased meanwhile: the next attempt sends it anew.
    if (fault && [fault.code, ...(fault.errors ?? []).map(({ code }) => code)].includes("unknown-image")) PLACES[name].uploaded.value = null;
  });
  if (problem.code === "unknown-image") for (const name of PLACE_NAMES) PLACES[name].uploaded.value = null;
  scanProblem.value = rest;
}
