// The fit that is being prepared: a person, and one to six pictures of them, one of which is looked at.
import { batch, computed, signal } from "@preact/signals";
import type { Signal } from "@preact/signals";
import type { Clothing, Cues, Facing, Limb, PointsProposal, Problem, UploadedImage, ViewKind } from "../api/types";
import { messages } from "../messages";
import type { Stroke } from "../mask/strokes";
import type { PointName } from "../points/catalogue";
import { NO_POINTS, isEnough, nextDoubt, nextPoint } from "../points/placed";
import type { Points } from "../points/placed";
import { advance, amend, begin } from "../points/timeline";
import type { Timeline } from "../points/timeline";
import { viewLabels } from "../messages/viewNames";
import { NOBODY, heightFault, tapeFault, weightFault } from "./person";
import type { Person } from "./person";
import type { Picture } from "./picture";

/** Whose points the service is to propose. */
export interface Wish {
  /** Place among the persons found; null leaves the choice to the service. */
  readonly person: number | null;
  /** Somebody asked: what there is may be replaced. */
  readonly replaces: boolean;
}

/** A picture with all that is said of it. */
export interface DraftView {
  readonly picture: Picture;
  /** From where it shows the person; of one picture alone nobody asks. */
  readonly view: Signal<ViewKind>;
  readonly uploaded: Signal<UploadedImage | null>;
  /** Why the service did not take it. */
  readonly problem: Signal<Problem | null>;
  readonly wish: Signal<Wish | null>;
  /** The last answer about this picture: points, mask and findings. */
  readonly proposal: Signal<PointsProposal | null>;
  readonly proposalProblem: Signal<Problem | null>;
  readonly timeline: Signal<Timeline<Points>>;
  /** Who is the person and who is not, white on black; null leaves it to the proposal. */
  readonly mask: Signal<Picture | null>;
  /** What brushes did to the mask. */
  readonly strokes: Signal<Timeline<readonly Stroke[]>>;
  /** 35 mm equivalent chosen by eye; null leaves it to the picture's own data, or to be assumed. */
  readonly focalLength: Signal<number | null>;
  readonly clothing: Signal<Clothing>;
  readonly facing: Signal<Readonly<Partial<Record<Limb, Facing>>>>;
}

/** In the order in which pictures are added. */
const KINDS: readonly ViewKind[] = ["front", "side", "back", "other"];

export const MOST_VIEWS = 6;

const NO_STROKES: readonly Stroke[] = [];

export const views = signal<readonly DraftView[]>([]);
const at = signal(0);
/** The picture that is looked at; null while there is none. */
export const current = computed<DraftView | null>(() => views.value[at.value] ?? null);

export const person = signal<Person>(NOBODY);
export const cues = signal<Cues>("SES");
/** Whether what there is to correct before a fit is shown. */
export const isCorrecting = signal(false);
/** The point that keys move, hide and delete. */
export const selected = signal<PointName | null>(null);

/** What belongs to a picture, of the one that is looked at; there has to be one. */
function ofCurrent<T>(pick: (view: DraftView) => Signal<T>): { value: T } {
  return {
    get value() {
      return pick(current.value!).value;
    },
    set value(next: T) {
      pick(current.value!).value = next;
    },
  };
}

export const timeline = ofCurrent((view) => view.timeline);
export const mask = ofCurrent((view) => view.mask);
export const strokes = ofCurrent((view) => view.strokes);
export const focalLength = ofCurrent((view) => view.focalLength);
export const clothing = ofCurrent((view) => view.clothing);
export const facing = ofCurrent((view) => view.facing);

export const points = computed<Points>(() => current.value?.timeline.value.present ?? NO_POINTS);
export const upcoming = computed(() => nextPoint(points.value));
/** The proposed point that is asked about. */
export const doubted = computed(() => nextDoubt(points.value));

export function change(next: Points): void {
  timeline.value = advance(timeline.value, next);
}

export function adjust(next: Points): void {
  timeline.value = amend(timeline.value, next);
}

/** Nothing is said of it yet, but from where it may show the person. */
export function newView(picture: Picture, number: number): DraftView {
  return {
    picture,
    view: signal<ViewKind>(KINDS[number] ?? "other"),
    uploaded: signal(picture.kept),
    problem: signal<Problem | null>(null),
    wish: signal<Wish | null>({ person: null, replaces: false }),
    proposal: signal<PointsProposal | null>(null),
    proposalProblem: signal<Problem | null>(null),
    timeline: signal(begin<Points>(NO_POINTS)),
    mask: signal<Picture | null>(null),
    strokes: signal(begin(NO_STROKES)),
    focalLength: signal<number | null>(null),
    clothing: signal<Clothing>("auto"),
    facing: signal<Readonly<Partial<Record<Limb, Facing>>>>({}),
  };
}

/** With other pictures, or without one, everything begins anew; only the units stay. */
export function beginWith(next: readonly DraftView[]): void {
  batch(() => {
    views.value = next;
    person.value = { ...NOBODY, units: person.value.units };
    cues.value = "SES";
    isCorrecting.value = false;
    lookAt(0);
  });
}

export function lookAt(number: number): void {
  batch(() => {
    at.value = number;
    selected.value = null;
  });
}

/** Another picture of the same person. */
export function addView(picture: Picture): void {
  batch(() => {
    views.value = [...views.value, newView(picture, views.value.length)];
    lookAt(views.value.length - 1);
  });
}

/** Another picture in the place of the one that is looked at. */
export function replaceView(picture: Picture): void {
  const before = current.value!;
  const next = newView(picture, at.value);
  next.view.value = before.view.value;
  batch(() => {
    views.value = views.value.map((each) => (each === before ? next : each));
    selected.value = null;
  });
}

export function removeView(): void {
  batch(() => {
    views.value = views.value.filter((each) => each !== current.value);
    lookAt(0);
  });
}

export function useMask(next: Picture | null): void {
  if (mask.value) URL.revokeObjectURL(mask.value.url);
  batch(() => {
    mask.value = next;
    strokes.value = begin(NO_STROKES);
  });
}

/** Whether this service can propose points, as far as is known. */
export const canPropose = signal(true);

/** Whether the service is still to say where the points of a picture are. */
export function isAwaiting({ wish, timeline: line, problem }: DraftView): boolean {
  const { placed } = line.value.present;
  return canPropose.value && wish.value !== null && problem.value === null && (wish.value.replaces || Object.keys(placed).length === 0);
}

/** Why there can be no fit yet, as a thing to do; null when there can. */
export const todo = computed<string | null>(() => {
  const { todo } = messages.person;
  if (views.value.length === 0) return todo.picture;
  if (person.value.gender === null) return todo.gender;
  if (heightFault(person.value) !== null) return todo.height;
  if (weightFault(person.value) !== null) return todo.weight;
  if (tapeFault(person.value) !== null) return todo.tape;
  const bare = views.value.findIndex((each) => !isAwaiting(each) && !isEnough(each.timeline.value.present));
  if (bare < 0) return null;
  return views.value.length === 1 ? todo.points : todo.pointsOf(labels.value[bare]!);
});

/** By which each of several pictures is told from the others. */
export const labels = computed(() => viewLabels(views.value.map(({ view }) => ({ view: view.value }))));
