// What follows the draft by itself: the upload of its picture, and the body its clicks make.
import { effect, signal, untracked } from "@preact/signals";
import { initialPose } from "../api/calls";
import { problemFrom } from "../api/client";
import { UNREACHABLE, isOffline, pauseMs } from "../api/connection";
import type { InitialPose, Problem } from "../api/types";
import { isEnough } from "../points/placed";
import { isAsleep, picture, points, todo, uploaded } from "./draft";
import { draftedInitialPose, draftedSubject } from "./request";
import { uploadProblem, uploadUntilKept } from "./uploading";

/** The body of the clicks so far; stays while a newer one is on its way. */
export const liveBody = signal<InitialPose | null>(null);
export const liveProblem = signal<Problem | null>(null);

const PAUSE_MS = 60;

export function startLive(): void {
  effect(() => {
    const chosen = picture.value;
    uploadProblem.value = null;
    if (!chosen || isAsleep.value) return undefined;
    if (chosen.kept) {
      uploaded.value = chosen.kept;
      return undefined;
    }
    const leaving = new AbortController();
    // Once a picture, whatever else a request looks at.
    untracked(() => void uploadUntilKept(chosen.file, leaving.signal));
    return () => leaving.abort();
  });
  effect(() => {
    const chosen = picture.value;
    const subject = draftedSubject();
    if (!chosen || isAsleep.value || !subject || !isEnough(points.value) || todo.value !== null) {
      liveBody.value = null;
      liveProblem.value = null;
      return undefined;
    }
    // Asked for once there is a connection again.
    if (isOffline.value) return undefined;
    const leaving = new AbortController();
    const asked = draftedInitialPose(subject, chosen.width, chosen.height, uploaded.value?.id ?? null);
    const ask = (attempts: number) =>
      initialPose(asked, leaving.signal).then(
        (body) => {
          liveBody.value = body;
          liveProblem.value = null;
        },
        (error) => {
          const problem = problemFrom(error);
          if (problem?.code === UNREACHABLE) timer = setTimeout(() => void ask(attempts + 1), pauseMs(attempts));
          else if (problem) {
            liveBody.value = null;
            liveProblem.value = problem;
          }
        },
      );
    let timer = setTimeout(() => void ask(0), PAUSE_MS);
    return () => {
      clearTimeout(timer);
      leaving.abort();
    };
  });
}
