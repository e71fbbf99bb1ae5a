// Whether the site has said whom to measure.
import { signal } from "@preact/signals";

export const isStarted = signal(false);
