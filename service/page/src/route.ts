// Where the page is, by the address's fragment: `#/` prepares a fit, `#/fits/ID` shows one.
import { computed, signal } from "@preact/signals";

const fragment = signal(location.hash);
addEventListener("hashchange", () => (fragment.value = location.hash));

export const openFit = computed<string | null>(() => /^#\/fits\/([0-9a-f-]{36})$/.exec(fragment.value)?.[1] ?? null);

export function fitAddress(id: string): string {
  return `#/fits/${id}`;
}

export function go(address: string): void {
  location.hash = address;
}
