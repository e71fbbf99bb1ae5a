// Whether the window is as narrow as a phone's: the same width as in the style sheets.
import { signal } from "@preact/signals";

const phones = matchMedia("(max-width: 700px)");

export const isNarrow = signal(phones.matches);
phones.addEventListener("change", () => (isNarrow.value = phones.matches));
