// Fits that are looked at: their jobs, and their energies as they go down.
import { signal } from "@preact/signals";
import { getFit } from "../api/calls";
import { jobEvents } from "../api/events";
import type { EventData, Job, JobState } from "../api/types";
import { seen } from "../history/store";

export interface Reading {
  readonly stage: string;
  readonly progress: number;
  readonly energies: Readonly<Record<string, number>>;
  readonly total: number;
}

const ACTIVE: readonly JobState[] = ["queued", "running"];

export function isActive(job: Pick<Job, "state">): boolean {
  return ACTIVE.includes(job.state);
}

export const readings = signal<Readonly<Record<string, readonly Reading[]>>>({});

/** Follow a job to its end; returns as soon as it has ended. */
export async function watch(id: string, signal: AbortSignal): Promise<void> {
  let job = await getFit(id);
  seen(job);
  if (!isActive(job)) return;
  readings.value = { ...readings.value, [id]: [] };
  for await (const data of jobEvents(job.links.events, signal)) {
    job = { ...job, state: data.state, stage: data.stage, progress: data.progress };
    // Of an ended job the links are needed as well, which events do not tell.
    if (isActive(job)) seen(job);
    note(id, data);
  }
  seen(await getFit(id));
}

function note(id: string, data: EventData): void {
  const energies = data.energies ?? {};
  const terms = Object.values(energies);
  if (terms.length === 0 || data.stage === null) return;
  const total = terms.reduce((sum, term) => sum + term, 0);
  const reading: Reading = { stage: data.stage, progress: data.progress, energies, total };
  readings.value = { ...readings.value, [id]: [...(readings.value[id] ?? []), reading] };
}
