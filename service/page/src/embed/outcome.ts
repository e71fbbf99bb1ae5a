// What becomes of the scan, told to the site as it happens.
import { effect } from "@preact/signals";
import { getScanResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem, Scan } from "../api/types";
import { canPropose } from "../draft/proposing";
import { isActive } from "../fit/watch";
import { NOT_INSTALLED } from "../measure/faults";
import { scanProblem } from "../measure/send";
import { scanTrouble, scans } from "../measure/watch";
import { openScan } from "../route";
import { tell } from "./parent";
import { resultFor } from "./result";

/** Scans whose end was told. */
const ended = new Set<string>();

/** Whether there is a scan whose end is still to be told. */
export function isUnderWay(): boolean {
  return openScan.value !== null && !ended.has(openScan.value);
}

export function startTelling(): void {
  effect(() => {
    const scan = openScan.value === null ? undefined : scans.value[openScan.value];
    if (!scan || ended.has(scan.id)) return;
    if (isActive(scan)) tell({ type: "maquette:progress", stage: scan.stage ?? scan.state, share: scan.progress });
    else tellEnd(scan);
  });
  effect(() => fail(scanProblem.value));
  effect(() => {
    const id = openScan.value;
    if (id === null || scanTrouble.value === null || ended.has(id)) return;
    ended.add(id);
    fail(scanTrouble.value);
  });
  effect(() => {
    if (canPropose.value) return;
    const detail = "This service cannot find people in pictures: its detector is not installed.";
    tell({ type: "maquette:failed", problem: { code: NOT_INSTALLED, status: 501, title: "No detector", detail, remedy: "Whoever runs the service installs it." } });
  });
}

function tellEnd(scan: Scan): void {
  ended.add(scan.id);
  if (scan.state === "canceled") tell({ type: "maquette:cancelled" });
  else if (scan.state === "succeeded") {
    getScanResult(scan).then(
      (result) => tell({ type: "maquette:result", ...resultFor(scan.id, result) }),
      (error) => fail(problemFrom(error)),
    );
  } else fail(scan.problem ?? null);
}

function fail(problem: Problem | null): void {
  if (!problem) return;
  const { code, status, title, detail, remedy } = problem;
  tell({ type: "maquette:failed", problem: { code, status, title, detail, remedy } });
}
