// From two places to a fit, and back from a fit to the places.
import { signal } from "@preact/signals";
import { getAsked, getPicture, submitScan, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Fit } from "../api/fits";
import type { Gender, Problem, ScanOfImages } from "../api/types";
import { person } from "../draft/draft";
import { describedPerson, loadPerson } from "../draft/request";
import { seen } from "../history/store";
import { MEASURE_ADDRESS, fitAddress, go } from "../route";
import { NOT_INSTALLED, faultsOfPlaces, isErased } from "./faults";
import { PLACES, PLACE_NAMES, emptyPlace, placesOf, putPicture } from "./places";
import type { PlaceName } from "./places";
import { canPropose } from "../draft/proposing";
import { pictureOf } from "./views";
import { noteSent, takeUpSent } from "./sent";

/** What is wrong with what was sent as a whole. */
export const scanProblem = signal<Problem | null>(null);

/** How many pictures of the fit that was opened again have no place here. */
export const leftOut = signal(0);

/** Ask for the measurements of the person in both places. */
export async function measure(): Promise<void> {
  const { gender } = person.value;
  if (gender === null) return;
  scanProblem.value = null;
  leftOut.value = 0;
  try {
    // A picture may have been erased since it was uploaded, or belong to a token that has expired: it is sent anew, once.
    const fit = await submitted(gender).catch((error) => {
      const problem = problemFrom(error);
      if (!problem || !isErased(problem)) throw error;
      for (const name of PLACE_NAMES) PLACES[name].uploaded.value = null;
      return submitted(gender);
    });
    seen(fit);
    noteSent();
    go(fitAddress(fit));
  } catch (error) {
    const problem = problemFrom(error);
    if (problem) tell(problem, PLACE_NAMES);
  }
}

async function submitted(gender: Gender): Promise<Fit> {
  const views = await Promise.all(PLACE_NAMES.map(async (name) => ({ view: name, points: "auto" as const, image_id: await imageOf(name) })));
  return submitScan({ ...describedPerson(gender, person.value), cues: "SES", force: false, views: views as ScanOfImages["views"] });
}

/** The pictures of a fit and its person, to be changed and sent again; what is wrong with them is told where it belongs. */
export async function reopen(fit: Fit): Promise<void> {
  const asked = await getAsked(fit);
  loadPerson(asked);
  takeUpSent();
  const order = placesOf(asked.views);
  for (const name of PLACE_NAMES) {
    const sent = fit.pictures[order.indexOf(name)];
    if (sent) await putPicture(PLACES[name], await getPicture(sent.image), pictureOf(name));
    else emptyPlace(PLACES[name]);
  }
  leftOut.value = order.filter((name) => name === null).length;
  scanProblem.value = null;
  if (fit.problem) tell(fit.problem, order);
  go(MEASURE_ADDRESS);
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
