// The two pictures that are measured: each with its upload and with what the service says of it.
import { computed, effect, signal } from "@preact/signals";
import type { Signal } from "@preact/signals";
import { checkCapture, uploadImage } from "../api/calls";
import { ProblemError, problemFrom } from "../api/client";
import type { CaptureCheck, Problem, UploadedImage } from "../api/types";
import { person } from "../draft/draft";
import { heightFault, heightM, tapeFault, weightFault } from "../draft/person";
import { openPicture } from "../draft/chosen";
import type { Picture } from "../draft/picture";
import { canPropose } from "../draft/proposing";
import { messages } from "../messages";
import { announce } from "../ui/announce";
import { answered } from "../ui/answered";
import { NOT_INSTALLED, isUnusable } from "./faults";
import { pictureOf, viewLabel } from "./views";

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
  const { measure, person: said } = messages;
  if (person.value.gender === null) return said.todo.gender;
  if (heightM(person.value) === null) return measure.todo.height;
  if (heightFault(person.value) !== null) return said.todo.height;
  if (weightFault(person.value) !== null) return said.todo.weight;
  if (tapeFault(person.value) !== null) return said.todo.tape;
  const missing = PLACE_NAMES.find((name) => PLACES[name].picture.value === null);
  if (missing) return measure.todo.add(pictureOf(missing));
  const unusable = PLACE_NAMES.find((name) => {
    const problem = PLACES[name].problem.value;
    return problem !== null && isUnusable(problem);
  });
  return unusable ? measure.todo.again(pictureOf(unusable)) : null;
});

/** Which place each view of a scan belongs to, null for those that have none here: a second side, or the back. */
export function placesOf(views: readonly { readonly view?: string }[]): readonly (PlaceName | null)[] {
  return views.map(({ view }, number) => {
    const name = PLACE_NAMES.find((each) => each === view) ?? null;
    return name !== null && views.findIndex((other) => other.view === view) === number ? name : null;
  });
}

export function emptyPlace({ picture, uploaded, check, problem }: Place): void {
  if (picture.value) URL.revokeObjectURL(picture.value.url);
  picture.value = null;
  uploaded.value = null;
  check.value = null;
  problem.value = null;
}

/** Take this file for a place; raises an Error that says what to do where it is no picture. */
export async function putPicture(place: Place, file: Blob, name: string): Promise<void> {
  const opened = await openPicture(file, name);
  emptyPlace(place);
  place.picture.value = opened;
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
    if (chosen.kept) {
      each.uploaded.value = chosen.kept;
      return undefined;
    }
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
    const ask = () => {
      checkCapture({ image_id: kept.id, view: each.name, points: {}, format: "named", ...known }, leaving.signal).then(
        (found) => take(each, found),
        (error) => {
          // Those that look at pictures are few: it is asked again when the service says so.
          if (error instanceof ProblemError && error.problem.status === 503 && error.retryAfterS !== null) {
            timer = setTimeout(ask, 1000 * error.retryAfterS);
            return;
          }
          const problem = problemFrom(error);
          if (!problem) return;
          each.isChecking.value = false;
          if (problem.code === NOT_INSTALLED) canPropose.value = false;
          else each.problem.value = problem;
        },
      );
    };
    let timer = setTimeout(ask, PAUSE_MS);
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
  const [first] = found.findings;
  const { place: words } = messages.measure;
  announce(words.told(viewLabel(each.name), first ? (answered("findings", first.code) ?? first.reason) : words.good));
}
