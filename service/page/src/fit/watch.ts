// Fits that are looked at: where each stands.
import { signal } from "@preact/signals";
import { getFit } from "../api/calls";
import { untilReached } from "../api/client";
import { fitEvents } from "../api/events";
import type { JobState, Problem } from "../api/types";
import { seen } from "../history/store";

const ACTIVE: readonly JobState[] = ["queued", "running"];

export function isActive({ state }: { readonly state: JobState }): boolean {
  return ACTIVE.includes(state);
}

/** Why the fit that is open cannot be followed or shown. */
export const trouble = signal<Problem | null>(null);

/** Follow a fit to its end; returns as soon as it has ended. */
export async function watch(id: string, signal: AbortSignal): Promise<void> {
  let fit = await getFit(id);
  seen(fit);
  if (!isActive(fit)) return;
  for await (const { state, stage, progress, view } of fitEvents(fit.links.events, signal)) {
    fit = { ...fit, state, stage, progress, view: view ?? null };
    // Of an ended fit the links are needed as well, which events do not tell.
    if (isActive(fit)) seen(fit);
  }
  seen(await untilReached(() => getFit(id), signal));
}
