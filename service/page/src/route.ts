// Where the page is, by the address's fragment: `#/` prepares a fit, `#/fits/ID` shows one; `#/measure` takes the
// pictures of a scan, `#/scans/ID` shows one.
import { computed, signal } from "@preact/signals";

const fragment = signal(location.hash);
addEventListener("hashchange", () => (fragment.value = location.hash));

export const openFit = computed<string | null>(() => /^#\/fits\/([0-9a-f-]{36})$/.exec(fragment.value)?.[1] ?? null);

export const openScan = computed<string | null>(() => /^#\/scans\/([0-9a-f-]{36})$/.exec(fragment.value)?.[1] ?? null);

export const MEASURE_ADDRESS = "#/measure";
export const isMeasuring = computed(() => fragment.value === MEASURE_ADDRESS);

export function scanAddress(id: string): string {
  return `#/scans/${id}`;
}

export function fitAddress(id: string): string {
  return `#/fits/${id}`;
}

export function go(address: string): void {
  location.hash = address;
}
