// Where the page is, by the address's fragment: `#/` is its start, `#/prepare` prepares a fit of one picture, `#/measure`
// takes the pictures of one of several; `#/fits/ID` and `#/scans/ID` show them; `#/people/LABEL` shows all of a person;
// `#/accuracy` tells how good measurements are. `#/embed` is for frames of other sites.
import { computed, signal } from "@preact/signals";
import type { FitKind, FitRef } from "./api/fits";

const fragment = signal(location.hash);
addEventListener("hashchange", () => (fragment.value = location.hash));

export const openFit = computed<FitRef | null>(() => {
  const found = /^#\/(fit|scan)s\/([0-9a-f-]{36})$/.exec(fragment.value);
  return found && { kind: found[1] as FitKind, id: found[2]! };
});

export const START_ADDRESS = "#/";

export const PREPARE_ADDRESS = "#/prepare";
export const isPreparing = computed(() => fragment.value === PREPARE_ADDRESS);

export const openPerson = computed<string | null>(() => {
  const written = /^#\/people\/(.+)$/.exec(fragment.value)?.[1];
  return written === undefined ? null : decoded(written);
});

export const MEASURE_ADDRESS = "#/measure";
export const isMeasuring = computed(() => fragment.value === MEASURE_ADDRESS);

export const ACCURACY_ADDRESS = "#/accuracy";
export const isOnAccuracy = computed(() => fragment.value === ACCURACY_ADDRESS);
/** Whether the page was opened to be a part of another site's. */
export const isEmbedded = location.hash === "#/embed";

export function personAddress(label: string): string {
  return `#/people/${encodeURIComponent(label)}`;
}

/** As it stands where somebody typed it with a percent sign of its own. */
function decoded(written: string): string {
  try {
    return decodeURIComponent(written);
  } catch {
    return written;
  }
}

export function fitAddress({ kind, id }: FitRef): string {
  return `#/${kind}s/${id}`;
}

/** Where another of its kind is begun. */
export function beginning(kind: FitKind): string {
  return kind === "fit" ? START_ADDRESS : MEASURE_ADDRESS;
}

export function go(address: string): void {
  // In a frame the address stays: the way back that the browser offers is the site's.
  if (!isEmbedded) location.hash = address;
  // At once: `hashchange` comes later.
  fragment.value = address;
}
