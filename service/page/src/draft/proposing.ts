// Points proposed by the service: asked for as soon as the picture is there, or by a button.
import { batch, computed, effect, signal } from "@preact/signals";
import { proposePoints } from "../api/calls";
import { problemFrom } from "../api/client";
import type { PointsProposal, Problem } from "../api/types";
import { listed } from "../messages/figures";
import { messages } from "../messages";
import { NO_POINTS } from "../points/placed";
import { countProposed, isAllProposed, personAt, proposedPoints } from "../points/proposed";
import { announce } from "../ui/announce";
import { change, doubted, points, selected, timeline, uploaded } from "./draft";
import { uploadProblem } from "./uploading";

interface Wish {
  /** Place among the persons found; null leaves the choice to the service. */
  readonly person: number | null;
  /** Somebody asked: what there is may be replaced. */
  readonly replaces: boolean;
}

const NOT_INSTALLED = "detector-not-installed";

const wish = signal<Wish | null>(null);
/** The last answer about this picture. */
export const proposal = signal<PointsProposal | null>(null);
export const proposalProblem = signal<Problem | null>(null);
/** Whether this service can propose points, as far as is known. */
export const canPropose = signal(true);
export const isProposing = computed(() => wish.value !== null && uploadProblem.value === null);
/** Everybody found, where somebody may be meant whose points are not those proposed. */
export const others = computed(() => {
  const persons = proposal.value?.persons ?? [];
  return persons.length > 1 && isAllProposed(points.value) ? persons.map((each) => each.box) : [];
});

/** What is to be known at once, while it holds. */
export const proposalWord = computed(() => {
  const { stage } = messages;
  if (isProposing.value) return stage.proposing;
  const isEmpty = Object.keys(points.value.placed).length === 0;
  if (proposal.value?.person === null && isEmpty) return stage.nobody;
  if (others.value.length > 0) return stage.several(others.value.length);
  return null;
});

export interface ProposalSoFar {
  readonly proposal: PointsProposal | null;
  readonly isAwaited: boolean;
}

export const proposalSoFar = computed<ProposalSoFar>(() => ({ proposal: proposal.value, isAwaited: wish.value !== null }));

export function restoreProposal({ proposal: found, isAwaited }: ProposalSoFar): void {
  forgetProposal();
  proposal.value = found;
  if (isAwaited) proposeFirst();
}

/** Nothing is known of the picture that comes next. */
export function forgetProposal(): void {
  wish.value = null;
  proposal.value = null;
  proposalProblem.value = null;
}

/** Propose points of a new picture, unless somebody clicks first. */
export function proposeFirst(): void {
  if (canPropose.value) wish.value = { person: null, replaces: false };
}

/** Propose points in place of those there are. */
export function propose(person: number | null = points.value.person ?? proposal.value?.person ?? null): void {
  wish.value = { person, replaces: true };
}

/** No proposals: all points are clicked. */
export function clickAll(): void {
  wish.value = null;
  change(NO_POINTS);
  selected.value = null;
}

/** Propose the points of the person tapped on, if they are another one's. */
export function choosePersonAt(x: number, y: number): void {
  const person = personAt(others.value, x, y);
  if (person !== null && person !== points.value.person) propose(person);
}

export function startProposing(): void {
  effect(() => {
    const wanted = wish.value;
    const kept = uploaded.value;
    if (!wanted || !kept) return undefined;
    const leaving = new AbortController();
    proposalProblem.value = null;
    proposePoints({ image_id: kept.id, person: wanted.person, mask: true }, leaving.signal).then(
      // Nobody sees that the wish is gone before its answer is there.
      (found) =>
        batch(() => {
          wish.value = null;
          take(found, wanted);
        }),
      (error) => {
        const problem = problemFrom(error);
        if (!problem) return;
        batch(() => {
          wish.value = null;
          if (problem.code === NOT_INSTALLED) canPropose.value = false;
          else proposalProblem.value = problem;
        });
      },
    );
    return () => leaving.abort();
  });
}

function take(found: PointsProposal, wanted: Wish): void {
  proposal.value = found;
  if (found.person === null) {
    announce(messages.stage.nobody);
    return;
  }
  // Who has begun to click goes on.
  const hasBegun = timeline.value.past.length > 0 || Object.keys(points.value.placed).length > 0;
  if (hasBegun && !wanted.replaces) return;
  change(proposedPoints(found));
  selected.value = null;
  announce(inWords(found));
}

function inWords(found: PointsProposal): string {
  const { stage, points: words } = messages;
  const people = found.persons.length > 1 ? [stage.severalFound(found.persons.length)] : [];
  const doubts = doubted.value ? [stage.lookAt(listed(points.value.doubts.map((name) => words.labels[name])))] : [];
  return [...people, stage.proposed(countProposed(points.value)), ...doubts].join(" ");
}
