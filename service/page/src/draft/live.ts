// The body that the points of a picture make, while they are placed.
import { effect, signal } from "@preact/signals";
import { initialPose } from "../api/calls";
import { problemFrom } from "../api/client";
import { UNREACHABLE, isOffline, pauseMs } from "../api/connection";
import type { InitialPose, Problem } from "../api/types";
import { isEnough } from "../points/placed";
import { current, person, points } from "./draft";
import { heightFault, tapeFault, weightFault } from "./person";
import { initialPoseRequest } from "./request";

/** The body of the clicks so far; stays while a newer one is on its way. */
export const liveBody = signal<InitialPose | null>(null);
export const liveProblem = signal<Problem | null>(null);

const PAUSE_MS = 60;

export function startLive(): void {
  effect(() => {
    const view = current.value;
    const { gender } = person.value;
    const isClear = heightFault(person.value) === null && weightFault(person.value) === null && tapeFault(person.value) === null;
    if (!view || gender === null || !isClear || !isEnough(points.value)) {
      liveBody.value = null;
      liveProblem.value = null;
      return undefined;
    }
    // Asked for once there is a connection again.
    if (isOffline.value) return undefined;
    const leaving = new AbortController();
    const asked = initialPoseRequest(view, gender);
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
