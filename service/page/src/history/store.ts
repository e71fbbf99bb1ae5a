// The fits this browser has started or opened: ids, a small picture and the waist, nothing else.
import { signal } from "@preact/signals";
import type { Fit } from "../api/types";
import { keep as keepText, kept } from "../kept";

export interface Entry {
  readonly id: string;
  readonly name: string;
  readonly startedAt: string;
  /** A small JPEG as a data address. */
  readonly thumbnail: string;
  /** Once its result was seen: of the smallest waist, centimetres. */
  readonly waistCm?: number;
}

const PLACE = "maquette.fits";
const MOST = 60;
export const THUMBNAIL_PX = 96;

export const entries = signal<readonly Entry[]>(load());

/** Fits as last seen, by id. */
export const fits = signal<Readonly<Record<string, Fit>>>({});

export function remember(entry: Entry): void {
  if (entries.value.some((each) => each.id === entry.id)) return;
  keep([entry, ...entries.value].slice(0, MOST));
}

/** What its result shows. */
export function amend(id: string, shown: Partial<Pick<Entry, "thumbnail" | "waistCm">>): void {
  keep(entries.value.map((each) => (each.id === id ? { ...each, ...shown } : each)));
}

export function forget(id: string): void {
  keep(entries.value.filter((each) => each.id !== id));
}

export function seen(fit: Fit): void {
  fits.value = { ...fits.value, [fit.id]: fit };
}

export function thumbnailOf(element: HTMLImageElement): string {
  const scale = THUMBNAIL_PX / Math.max(element.naturalWidth, element.naturalHeight);
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(element.naturalWidth * scale));
  canvas.height = Math.max(1, Math.round(element.naturalHeight * scale));
  canvas.getContext("2d")!.drawImage(element, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/jpeg", 0.7);
}

function keep(list: readonly Entry[]): void {
  entries.value = list;
  keepText(PLACE, JSON.stringify(list));
}

function load(): readonly Entry[] {
  try {
    const list: unknown = JSON.parse(kept(PLACE) ?? "[]");
    return Array.isArray(list) ? (list as Entry[]).filter((each) => typeof each?.id === "string") : [];
  } catch {
    return [];
  }
}
