// Whether the window is as narrow as a phone's, by the same width as in the style sheets; whether it is touched.
import { signal } from "@preact/signals";

const phones = matchMedia("(max-width: 700px)");

export const isNarrow = signal(phones.matches);
phones.addEventListener("change", () => (isNarrow.value = phones.matches));

/** Whether the device is held in the hand: it has a camera, and nothing is dragged onto its pages. */
export const IS_TOUCHED = matchMedia("(pointer: coarse)").matches;
