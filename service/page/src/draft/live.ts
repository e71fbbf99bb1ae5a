// What follows the draft by itself: the upload of its picture, and the body its clicks make.
import { effect, signal } from "@preact/signals";
import { initialPose, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { InitialPose, Problem } from "../api/types";
import { isEnough } from "../points/placed";
import { picture, points, todo, uploaded } from "./draft";
import { draftedInitialPose, draftedSubject } from "./request";

/** The body of the clicks so far; stays while a newer one is on its way. */
export const liveBody = signal<InitialPose | null>(null);
export const liveProblem = signal<Problem | null>(null);
export const uploadProblem = signal<Problem | null>(null);

const PAUSE_MS = 60;

export function startLive(): void {
  effect(() => {
    const chosen = picture.value;
    uploadProblem.value = null;
    if (!chosen) return undefined;
    const leaving = new AbortController();
    uploadImage(chosen.file, leaving.signal).then(
      (kept) => (uploaded.value = kept),
      (error) => (uploadProblem.value = problemFrom(error)),
    );
    return () => leaving.abort();
  });
  effect(() => {
    const chosen = picture.value;
    const subject = draftedSubject();
    if (!chosen || !subject || !isEnough(points.value) || todo.value !== null) {
      liveBody.value = null;
      liveProblem.value = null;
      return undefined;
    }
    const leaving = new AbortController();
    const asked = draftedInitialPose(subject, chosen.width, chosen.height, uploaded.value?.id ?? null);
    const timer = setTimeout(() => {
      initialPose(asked, leaving.signal).then(
        (body) => {
          liveBody.value = body;
          liveProblem.value = null;
        },
        (error) => {
          const problem = problemFrom(error);
          if (!problem) return;
          liveBody.value = null;
          liveProblem.value = problem;
        },
      );
    }, PAUSE_MS);
    return () => {
      clearTimeout(timer);
      leaving.abort();
    };
  });
}
