// Whom a scan was sent of: with its next picture begins the scan of somebody else.
import { forgetPerson } from "../draft/draft";
import { PLACES, PLACE_NAMES, emptyPlace } from "./places";
import type { PlaceName } from "./places";

let isSent = false;

export function noteSent(): void {
  isSent = true;
}

/** What is to be changed and sent again is of the same person. */
export function takeUpSent(): void {
  isSent = false;
}

/** Another picture has come: nothing of the person who was measured is left beside it. */
export function beginAnew(taken: PlaceName): void {
  if (!isSent) return;
  isSent = false;
  forgetPerson();
  for (const name of PLACE_NAMES) if (name !== taken) emptyPlace(PLACES[name]);
}
