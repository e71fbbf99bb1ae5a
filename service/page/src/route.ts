// Where the page is, by the address's fragment: `#/` is its start, `#/prepare` prepares a fit, `#/fits/ID` shows one;
// `#/accuracy` tells how good measurements are, `#/try` is for developers.
import { computed, signal } from "@preact/signals";

const fragment = signal(location.hash);
addEventListener("hashchange", () => (fragment.value = location.hash));

/** The id of the fit that is shown; null elsewhere. */
export const openFit = computed<string | null>(() => /^#\/fits\/([0-9a-f-]{36})$/.exec(fragment.value)?.[1] ?? null);

export const START_ADDRESS = "#/";

export const PREPARE_ADDRESS = "#/prepare";
export const isPreparing = computed(() => fragment.value === PREPARE_ADDRESS);

export const ACCURACY_ADDRESS = "#/accuracy";
export const isOnAccuracy = computed(() => fragment.value === ACCURACY_ADDRESS);

export const TRY_ADDRESS = "#/try";
export const isTrying = computed(() => fragment.value === TRY_ADDRESS);

export function fitAddress(id: string): string {
  return `#/fits/${id}`;
}

export function go(address: string): void {
  location.hash = address;
  // At once: `hashchange` comes later.
  fragment.value = address;
}
