// From two places to a scan, and back from a scan to the places.
import { signal } from "@preact/signals";
import { getFile, getPicture, getScanRequest, submitScan, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Gender, Problem, Scan, ScanOfImages } from "../api/types";
import { person } from "../draft/draft";
import { labelOf, personInWords } from "../draft/person";
import { describedPerson, loadPerson } from "../draft/request";
import { entries, remember, thumbnailOf } from "../history/store";
import { MEASURE_ADDRESS, go, scanAddress } from "../route";
import { NOT_INSTALLED, faultsOfPlaces, isErased } from "./faults";
import { PLACES, PLACE_NAMES, emptyPlace, placesOf, putPicture } from "./places";
import type { PlaceName } from "./places";
import { canPropose } from "../draft/proposing";
import { pictureOf } from "./views";
import { noteSent, takeUpSent } from "./sent";
import { seenScan } from "./watch";

/** What is wrong with the scan as a whole. */
export const scanProblem = signal<Problem | null>(null);

/** How many pictures of the scan that was opened again have no place here. */
export const leftOut = signal(0);

/** Ask for the measurements of the person in both places. */
export async function measure(): Promise<void> {
  const { gender } = person.value;
  if (gender === null) return;
  scanProblem.value = null;
  leftOut.value = 0;
  try {
    // A picture may have been erased since it was uploaded, or belong to a token that has expired: it is sent anew, once.
    const scan = await submitted(gender).catch((error) => {
      const problem = problemFrom(error);
      if (!problem || !isErased(problem)) throw error;
      for (const name of PLACE_NAMES) PLACES[name].uploaded.value = null;
      return submitted(gender);
    });
    seenScan(scan);
    noteSent();
    go(scanAddress(scan.id));
  } catch (error) {
    const problem = problemFrom(error);
    if (problem) tell(problem, PLACE_NAMES);
  }
}

async function submitted(gender: Gender): Promise<Scan> {
  const views = await Promise.all(PLACE_NAMES.map(async (name) => ({ view: name, points: "auto" as const, image_id: await imageOf(name) })));
  return submitScan({ ...describedPerson(gender, person.value), ...labelOf(person.value), cues: "SES", force: false, views: views as ScanOfImages["views"] });
}

/** A scan whose measurements are withheld, asked for once more by force. */
export async function measureByForce(scan: Scan): Promise<void> {
  const asked = await getScanRequest(scan);
  const copy = async (path: string) => (await uploadImage(await getFile(path), new AbortController().signal)).id;
  const images = await Promise.all(
    scan.links.views.map(async ({ image, mask }) => ({ image_id: await copy(image), ...(mask ? { mask_id: await copy(mask) } : {}) })),
  );
  const views = asked.views.map((view, number) => ({ ...view, ...images[number]! }));
  const begun = await submitScan({ ...asked, ...(scan.label ? { label: scan.label } : {}), force: true, views: views as ScanOfImages["views"] });
  seenScan(begun);
  go(scanAddress(begun.id));
}

/** The pictures of a scan and its person, to be changed and sent again; `problem` is told where it belongs. */
export async function reopen(scan: Scan, problem: Problem | null): Promise<void> {
  const asked = await getScanRequest(scan);
  loadPerson(asked);
  person.value = { ...person.value, label: scan.label ?? "" };
  takeUpSent();
  const order = placesOf(asked.views);
  for (const name of PLACE_NAMES) {
    const links = scan.links.views[order.indexOf(name)];
    if (links) await putPicture(PLACES[name], await getPicture(links.image), pictureOf(name));
    else emptyPlace(PLACES[name]);
  }
  leftOut.value = order.filter((name) => name === null).length;
  scanProblem.value = null;
  if (problem) tell(problem, order);
  go(MEASURE_ADDRESS);
}

/** From now on this browser knows the scan, whoever began it. */
export async function rememberScan(scan: Scan, picture: HTMLImageElement): Promise<void> {
  if (entries.value.some(({ id }) => id === scan.id)) return;
  const name = personInWords(await getScanRequest(scan), person.value.units);
  remember({ id: scan.id, name, startedAt: scan.created_at, thumbnail: thumbnailOf(picture), scan: true });
}

async function imageOf(name: (typeof PLACE_NAMES)[number]): Promise<string> {
  const { picture, uploaded } = PLACES[name];
  const kept = uploaded.value ?? (await uploadImage(picture.value!.file, new AbortController().signal));
  uploaded.value = kept;
  return kept.id;
}

function tell(problem: Problem, order: readonly (PlaceName | null)[]): void {
  if (problem.code === NOT_INSTALLED) {
    canPropose.value = false;
    return;
  }
  const { places, rest } = faultsOfPlaces(problem, order);
  for (const name of PLACE_NAMES) {
    const fault = places.get(name) ?? null;
    PLACES[name].problem.value = fault;
    if (fault && isErased(fault)) PLACES[name].uploaded.value = null;
  }
  if (rest && isErased(rest)) for (const name of PLACE_NAMES) PLACES[name].uploaded.value = null;
  scanProblem.value = rest;
}
