// What follows a picture by itself: its upload, and the points, the mask and the findings that the service answers.
import { batch, computed, effect, untracked } from "@preact/signals";
import { proposePoints, uploadImage } from "../api/calls";
import { ProblemError, problemFrom } from "../api/client";
import { UNREACHABLE, pause, pauseMs } from "../api/connection";
import type { PointsProposal, Problem } from "../api/types";
import { listed } from "../messages/figures";
import { messages } from "../messages";
import { NO_POINTS } from "../points/placed";
import { around, countProposed, isAllProposed, personAt, proposedPoints, wholePerson } from "../points/proposed";
import { advance, begin } from "../points/timeline";
import { announce } from "../ui/announce";
import { answered } from "../ui/answered";
import { canPropose, change, current, doubted, isAwaiting, points, selected, views } from "./draft";
import type { DraftView, Wish } from "./draft";

const NOT_INSTALLED = "detector-not-installed";

export const proposal = computed(() => current.value?.proposal.value ?? null);
export const isProposing = computed(() => current.value !== null && isAwaiting(current.value));
/** Everybody found, where somebody may be meant whose points are not those proposed. */
export const others = computed(() => {
  const persons = proposal.value?.persons ?? [];
  return persons.length > 1 && isAllProposed(points.value) ? persons : [];
});

/** Nobody was found, and nobody has begun to click. */
export const isNobody = computed(() => proposal.value?.person === null && Object.keys(points.value.placed).length === 0);
/** Where whoever may be meant is, to be looked at. */
export const looked = computed(() => around(proposal.value?.persons ?? []));

/** What is to be known at once, while it holds. */
export const proposalWord = computed(() => {
  const { stage } = messages;
  if (isProposing.value) return stage.proposing;
  // On a phone all that is said of it lies below the picture.
  const problem = current.value?.problem.value;
  if (problem) return answered("titles", problem.type.split("/").at(-1)!) ?? problem.title;
  if (isNobody.value) return stage.nobody;
  if (others.value.length > 0) return stage.several(others.value.length);
  return null;
});

/** Propose points in place of those there are. */
export function propose(person: number | null = points.value.person ?? proposal.value?.person ?? null): void {
  current.value!.wish.value = { person, replaces: true };
}

/** No proposals: all points are clicked. */
export function clickAll(): void {
  current.value!.wish.value = null;
  change(NO_POINTS);
  selected.value = null;
}

/** Propose the points of the person tapped on, if they are another one's. */
export function choosePersonAt(x: number, y: number): void {
  const person = personAt(others.value, x, y);
  if (person !== null && person !== points.value.person) propose(person);
}

/** Follow every picture of the draft for as long as it is one of them. */
export function startFollowing(): void {
  const followed = new Map<DraftView, () => void>();
  effect(() => {
    const now = views.value;
    untracked(() => {
      for (const [view, leave] of followed) {
        if (now.includes(view)) continue;
        leave();
        followed.delete(view);
      }
      for (const view of now) if (!followed.has(view)) followed.set(view, follow(view));
    });
  });
}

function follow(view: DraftView): () => void {
  const leaving = new AbortController();
  void uploadUntilKept(view, leaving.signal);
  const stop = effect(() => {
    const wanted = view.wish.value;
    const kept = view.uploaded.value;
    if (!wanted || !kept || !canPropose.value) return undefined;
    const asking = new AbortController();
    view.proposalProblem.value = null;
    void ask(view, kept.id, wanted, asking.signal);
    return () => asking.abort();
  });
  return () => {
    leaving.abort();
    stop();
    URL.revokeObjectURL(view.picture.url);
  };
}

/** Tried until the service has it, or says that it does not take it. */
async function uploadUntilKept({ picture, uploaded, problem }: DraftView, leaving: AbortSignal): Promise<void> {
  for (let attempts = 0; uploaded.value === null && !leaving.aborted; attempts++) {
    try {
      const kept = await uploadImage(picture.file, leaving);
      batch(() => {
        uploaded.value = kept;
        problem.value = null;
      });
    } catch (error) {
      const found = problemFrom(error);
      if (!found) return;
      problem.value = found;
      if (!isPassing(found)) return;
      await pause(pauseMs(attempts), leaving);
    }
  }
}

/** Whether the next attempt may end otherwise. */
function isPassing({ code, status }: Problem): boolean {
  return code === UNREACHABLE || status === 503;
}

async function ask(view: DraftView, imageId: string, wanted: Wish, asking: AbortSignal): Promise<void> {
  for (;;) {
    try {
      const found = await proposePoints({ image_id: imageId, person: wanted.person, mask: true, ...(views.peek().length > 1 ? { view: view.view.peek() } : {}) }, asking);
      // Nobody sees that the wish is gone before its answer is there.
      return batch(() => {
        view.wish.value = null;
        take(view, found, wanted);
      });
    } catch (error) {
      const problem = problemFrom(error);
      if (!problem || asking.aborted) return;
      // Those that look at pictures are few: it is asked again when the service says so.
      if (error instanceof ProblemError && problem.status === 503 && error.retryAfterS !== null) {
        await pause(1000 * error.retryAfterS, asking);
        continue;
      }
      return batch(() => {
        view.wish.value = null;
        if (problem.code === NOT_INSTALLED) canPropose.value = false;
        else view.proposalProblem.value = problem;
      });
    }
  }
}

function take(view: DraftView, found: PointsProposal, wanted: Wish): void {
  const { timeline, strokes } = view;
  const whole = wanted.person === null ? wholePerson(found) : null;
  if (whole !== null) {
    view.wish.value = { person: whole, replaces: wanted.replaces };
    return;
  }
  view.proposal.value = found;
  if (wanted.replaces) strokes.value = begin([]);
  if (found.person === null) {
    announce(messages.stage.nobody);
    return;
  }
  // Who has begun to click goes on.
  const { past, present } = timeline.value;
  if ((past.length > 0 || Object.keys(present.placed).length > 0) && !wanted.replaces) return;
  timeline.value = advance(timeline.value, proposedPoints(found));
  if (view !== current.value) return;
  selected.value = null;
  announce(inWords(found));
}

function inWords(found: PointsProposal): string {
  const { stage, points: words } = messages;
  const people = found.persons.length > 1 ? [stage.severalFound(found.persons.length)] : [];
  const doubts = doubted.value ? [stage.lookAt(listed(points.value.doubts.map((name) => words.labels[name])))] : [];
  return [...people, stage.proposed(countProposed(points.value)), ...doubts].join(" ");
}
