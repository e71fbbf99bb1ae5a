// What becomes of the fit, told to the site as it happens.
import { effect } from "@preact/signals";
import { getResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Fit } from "../api/fits";
import type { Problem } from "../api/types";
import { canPropose } from "../draft/proposing";
import { isActive, trouble } from "../fit/watch";
import { fits } from "../history/store";
import { NOT_INSTALLED } from "../measure/faults";
import { scanProblem } from "../measure/send";
import { openFit } from "../route";
import { tell } from "./parent";
import { resultFor } from "./result";

/** Fits whose end was told, by id. */
const ended = new Set<string>();

/** Whether there is a fit whose end is still to be told. */
export function isUnderWay(): boolean {
  return openFit.value !== null && !ended.has(openFit.value.id);
}

export function startTelling(): void {
  effect(() => {
    const fit = openFit.value === null ? undefined : fits.value[openFit.value.id];
    if (!fit || ended.has(fit.id)) return;
    if (isActive(fit)) tell({ type: "maquette:progress", stage: fit.stage ?? fit.state, share: fit.progress });
    else tellEnd(fit);
  });
  effect(() => fail(scanProblem.value));
  effect(() => {
    const id = openFit.value?.id ?? null;
    if (id === null || trouble.value === null || ended.has(id)) return;
    ended.add(id);
    fail(trouble.value);
  });
  effect(() => {
    if (canPropose.value) return;
    const detail = "This service cannot find people in pictures: its detector is not installed.";
    tell({ type: "maquette:failed", problem: { code: NOT_INSTALLED, status: 501, title: "No detector", detail, remedy: "Whoever runs the service installs it." } });
  });
}

function tellEnd(fit: Fit): void {
  ended.add(fit.id);
  if (fit.state === "canceled") tell({ type: "maquette:cancelled" });
  else if (fit.state === "succeeded") {
    getResult(fit).then(
      (result) => tell({ type: "maquette:result", ...resultFor(fit.id, result) }),
      (error) => fail(problemFrom(error)),
    );
  } else fail(fit.problem ?? null);
}

function fail(problem: Problem | null): void {
  if (!problem) return;
  const { code, status, title, detail, remedy } = problem;
  tell({ type: "maquette:failed", problem: { code, status, title, detail, remedy } });
}
