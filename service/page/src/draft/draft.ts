// The fit that is being prepared: a few signals, and what follows from them.
import { batch, computed, signal } from "@preact/signals";
import type { FitRef } from "../api/fits";
import type { Clothing, Cues, Facing, Limb, LightGuess, Surroundings, UploadedImage } from "../api/types";
import { messages } from "../messages";
import type { PointName } from "../points/catalogue";
import { NO_POINTS, isEnough, nextDoubt, nextPoint } from "../points/placed";
import type { Points } from "../points/placed";
import { advance, amend, begin } from "../points/timeline";
import { NOBODY, heightFault, tapeFault, weightFault } from "./person";
import type { Person } from "./person";
import type { Picture } from "./picture";

export const picture = signal<Picture | null>(null);
/** The fit of several pictures that this is one of, and which; null of a picture that is fitted alone. */
export const oneOf = signal<(FitRef & { readonly number: number }) | null>(null);
/** Of an earlier visit, and nobody has gone on with it yet: nothing of it is sent. */
export const isAsleep = signal(false);
export const uploaded = signal<UploadedImage | null>(null);

export const timeline = signal(begin<Points>(NO_POINTS));
export const points = computed(() => timeline.value.present);
export const upcoming = computed(() => nextPoint(points.value));
/** The proposed point that is asked about. */
export const doubted = computed(() => nextDoubt(points.value));
/** The point that keys move, hide and delete. */
export const selected = signal<PointName | null>(null);

export const person = signal<Person>(NOBODY);
/** 35 mm equivalent chosen by eye; null leaves it to the picture's own data, or to be assumed. */
export const focalLength = signal<number | null>(null);
/** The light shown on the ball; null leaves it to the fit. */
export const light = signal<LightGuess | null>(null);
/** Whether ambient light is taken as even, or as coming from everywhere by direction. */
export const surroundings = signal<Surroundings>("uniform");
export const clothing = signal<Clothing>("auto");
export const facing = signal<Readonly<Partial<Record<Limb, Facing>>>>({});
export const cues = signal<Cues>("SES");
/** Who is the person and who is not, white on black; null leaves it to the fit. */
export const mask = signal<Picture | null>(null);
/** Whether what there is to correct before a fit is shown. */
export const isCorrecting = signal(false);
/** Somebody said that the person turns their back. */
export const seenFromBehind = signal(false);

export function change(next: Points): void {
  timeline.value = advance(timeline.value, next);
}

export function adjust(next: Points): void {
  timeline.value = amend(timeline.value, next);
}

/** Nothing is known of whoever comes next but the units they are told in. */
export function forgetPerson(): void {
  person.value = { ...NOBODY, units: person.value.units };
}

/** With another picture, or without one, everything begins anew; only the units stay. */
export function usePicture(next: Picture | null): void {
  batch(() => {
    if (picture.value) URL.revokeObjectURL(picture.value.url);
    picture.value = next;
    oneOf.value = null;
    isAsleep.value = false;
    uploaded.value = null;
    timeline.value = begin<Points>(NO_POINTS);
    selected.value = null;
    forgetPerson();
    facing.value = {};
    focalLength.value = null;
    light.value = null;
    surroundings.value = "uniform";
    clothing.value = "auto";
    cues.value = "SES";
    seenFromBehind.value = false;
    isCorrecting.value = false;
    useMask(null);
  });
}

export function useMask(next: Picture | null): void {
  if (mask.value) URL.revokeObjectURL(mask.value.url);
  mask.value = next;
}

/** Why there can be no fit yet, as a thing to do; null when there can. */
export const todo = computed<string | null>(() => {
  const { todo } = messages.person;
  if (!picture.value) return todo.picture;
  if (person.value.gender === null) return todo.gender;
  if (heightFault(person.value) !== null) return todo.height;
  if (weightFault(person.value) !== null) return todo.weight;
  if (tapeFault(person.value) !== null) return todo.tape;
  if (!isEnough(points.value)) return todo.points;
  return null;
});
