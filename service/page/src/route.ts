// Where the page is, by the address's fragment: `#/` is its start, `#/prepare` prepares a fit of one picture, `#/measure`
// takes the pictures of one of several; `#/fits/ID` and `#/scans/ID` show them; `#/accuracy` tells
// how good measurements are.
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

export const MEASURE_ADDRESS = "#/measure";
export const isMeasuring = computed(() => fragment.value === MEASURE_ADDRESS);

export const ACCURACY_ADDRESS = "#/accuracy";
export const isOnAccuracy = computed(() => fragment.value === ACCURACY_ADDRESS);

export function fitAddress({ kind, id }: FitRef): string {
  return `#/${kind}s/${id}`;
}

/** Where another of its kind is begun. */
export function beginning(kind: FitKind): string {
  return kind === "fit" ? START_ADDRESS : MEASURE_ADDRESS;
}

export function go(address: string): void {
  location.hash = address;
  // At once: `hashchange` comes later.
  fragment.value = address;
}
