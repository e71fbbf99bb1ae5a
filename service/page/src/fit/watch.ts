// Fits that are looked at: where each stands, and its energies as they go down.
import { signal } from "@preact/signals";
import { getFit } from "../api/calls";
import { untilReached } from "../api/client";
import { jobEvents } from "../api/events";
import type { FitRef } from "../api/fits";
import type { EventData, JobState, Problem } from "../api/types";
import { seen } from "../history/store";

export interface Reading {
  readonly stage: string;
  readonly progress: number;
  readonly energies: Readonly<Record<string, number>>;
  readonly total: number;
}

const ACTIVE: readonly JobState[] = ["queued", "running"];

export function isActive({ state }: { readonly state: JobState }): boolean {
  return ACTIVE.includes(state);
}

export const readings = signal<Readonly<Record<string, readonly Reading[]>>>({});

/** Why the fit that is open cannot be followed or shown. */
export const trouble = signal<Problem | null>(null);

/** Follow a fit to its end; returns as soon as it has ended. */
export async function watch(which: FitRef, signal: AbortSignal): Promise<void> {
  let fit = await getFit(which);
  seen(fit);
  if (!isActive(fit)) return;
  readings.value = { ...readings.value, [fit.id]: [] };
  for await (const data of jobEvents(fit.links.events, signal)) {
    fit = { ...fit, state: data.state, stage: data.stage, progress: data.progress, view: data.view ?? null };
    // Of an ended fit the links are needed as well, which events do not tell.
    if (isActive(fit)) seen(fit);
    note(fit.id, data);
  }
  seen(await untilReached(() => getFit(which), signal));
}

function note(id: string, data: EventData): void {
  const energies = data.energies ?? {};
  const terms = Object.values(energies);
  if (terms.length === 0 || data.stage === null) return;
  const total = terms.reduce((sum, term) => sum + term, 0);
  const reading: Reading = { stage: data.stage, progress: data.progress, energies, total };
  readings.value = { ...readings.value, [id]: [...(readings.value[id] ?? []), reading] };
}
