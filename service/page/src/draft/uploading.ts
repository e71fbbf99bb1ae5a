// The upload of the draft's picture: tried until the service has it, or says that it does not take it.
import { batch, signal } from "@preact/signals";
import { uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import { UNREACHABLE, pause, pauseMs } from "../api/connection";
import type { Problem } from "../api/types";
import { uploaded } from "./draft";

export const uploadProblem = signal<Problem | null>(null);

export async function uploadUntilKept(file: Blob, leaving: AbortSignal): Promise<void> {
  for (let attempts = 0; !leaving.aborted; attempts++) {
    try {
      const kept = await uploadImage(file, leaving);
      batch(() => {
        uploaded.value = kept;
        uploadProblem.value = null;
      });
      return;
    } catch (error) {
      const problem = problemFrom(error);
      if (!problem) return;
      uploadProblem.value = problem;
      if (!isPassing(problem)) return;
    }
    await pause(pauseMs(attempts), leaving);
  }
}

/** Whether the next attempt may end otherwise. */
function isPassing({ code, status }: Problem): boolean {
  return code === UNREACHABLE || status === 503;
}
