// Scans that are looked at: where each stands.
import { signal } from "@preact/signals";
import { getScan } from "../api/calls";
import { jobEvents } from "../api/events";
import type { Problem, Scan } from "../api/types";
import { isActive } from "../fit/watch";

/** As last seen, by id. */
export const scans = signal<Readonly<Record<string, Scan>>>({});

/** Why the scan that is open cannot be followed or shown. */
export const scanTrouble = signal<Problem | null>(null);

export function seenScan(scan: Scan): void {
  scans.value = { ...scans.value, [scan.id]: scan };
}

/** Follow a scan to its end; returns as soon as it has ended. */
export async function watchScan(id: string, signal: AbortSignal): Promise<void> {
  let scan = await getScan(id);
  seenScan(scan);
  if (!isActive(scan)) return;
  for await (const { state, stage, progress, view } of jobEvents(scan.links.events, signal)) {
    scan = { ...scan, state, stage, progress, view: view ?? null };
    // Of an ended one the links are needed as well, which events do not tell.
    if (isActive(scan)) seenScan(scan);
  }
  seenScan(await getScan(id));
}
