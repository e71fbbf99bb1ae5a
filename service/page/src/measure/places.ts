// The two pictures that are measured: each with its upload and with what the service says of it.
import { computed, effect, signal } from "@preact/signals";
import type { Signal } from "@preact/signals";
import { checkCapture, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { CaptureCheck, Problem, UploadedImage } from "../api/types";
import { person } from "../draft/draft";
import { heightFault, heightM, tapeFault, weightFault } from "../draft/person";
import { openPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { canPropose } from "../draft/proposing";
import { announce } from "../ui/announce";
import { NOT_INSTALLED } from "./faults";

export type PlaceName = "front" | "side";

/** In the order of a scan's views. */
export const PLACE_NAMES: readonly PlaceName[] = ["front", "side"];

export interface Place {
  readonly name: PlaceName;
  readonly picture: Signal<Picture | null>;
  readonly uploaded: Signal<UploadedImage | null>;
  readonly check: Signal<CaptureCheck | null>;
  readonly isChecking: Signal<boolean>;
  /** What is wrong with the picture, as the service told on its upload, its check, or of a scan. */
  readonly problem: Signal<Problem | null>;
}

function place(name: PlaceName): Place {
  return {
    name,
    picture: signal<Picture | null>(null),
    uploaded: signal<UploadedImage | null>(null),
    check: signal<CaptureCheck | null>(null),
    isChecking: signal(false),
    problem: signal<Problem | null>(null),
  };
}

export const PLACES: Readonly<Record<PlaceName, Place>> = { front: place("front"), side: place("side") };

const PAUSE_MS = 250;

/** Why nothing can be measured yet, as a thing to do; null when it can. */
export const measureTodo = computed<string | null>(() => {
  if (person.value.gender === null) return "Choose female or male";
  if (heightM(person.value) === null) return "Give the height";
  if (heightFault(person.value) !== null) return "Correct the height";
  if (weightFault(person.value) !== null) return "Correct the weight";
  if (tapeFault(person.value) !== null) return "Correct a measurement";
  const missing = PLACE_NAMES.find((name) => PLACES[name].picture.value === null);
  return missing ? `Add the ${missing} picture` : null;
});

/** Take this file for a place; raises an Error that says what to do where it is no picture. */
export async function putPicture({ picture, uploaded, check, problem }: Place, file: Blob, name: string): Promise<void> {
  const opened = await openPicture(file, name);
  if (picture.value) URL.revokeObjectURL(picture.value.url);
  uploaded.value = null;
  check.value = null;
  problem.value = null;
  picture.value = opened;
}

/** Upload every picture that comes, and have it checked, anew whenever the height is another. */
export function startMeasuring(): void {
  for (const each of Object.values(PLACES)) {
    follow(each);
  }
}

function follow(each: Place): void {
  effect(() => {
    const chosen = each.picture.value;
    if (!chosen) return undefined;
    const leaving = new AbortController();
    uploadImage(chosen.file, leaving.signal).then(
      (kept) => (each.uploaded.value = kept),
      (error) => (each.problem.value = problemFrom(error)),
    );
    return () => leaving.abort();
  });
  // Of the person only what the check asks for: no other word starts it anew.
  const height = computed(() => (heightFault(person.value) === null ? heightM(person.value) : null));
  const gender = computed(() => person.value.gender);
  effect(() => {
    const kept = each.uploaded.value;
    const known = { gender: gender.value, height_m: height.value };
    if (!kept || !canPropose.value) return undefined;
    const leaving = new AbortController();
    each.isChecking.value = true;
    const timer = setTimeout(() => {
      checkCapture({ image_id: kept.id, view: each.name, points: {}, format: "named", ...known }, leaving.signal).then(
        (found) => take(each, found),
        (error) => {
          const problem = problemFrom(error);
          if (!problem) return;
          each.isChecking.value = false;
          if (problem.code === NOT_INSTALLED) canPropose.value = false;
          else each.problem.value = problem;
        },
      );
    }, PAUSE_MS);
    return () => {
      clearTimeout(timer);
      leaving.abort();
      each.isChecking.value = false;
    };
  });
}

function take(each: Place, found: CaptureCheck): void {
  each.isChecking.value = false;
  each.check.value = found;
  announce(`${each.name === "front" ? "Front" : "Side"}: ${found.findings[0]?.reason ?? "good to measure."}`);
}
