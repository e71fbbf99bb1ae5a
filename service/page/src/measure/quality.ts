// How far a scan is to be trusted, in a line.
import type { Finding, ScanResult } from "../api/types";
import { isContradicted } from "../result/outcome";

/** Told by the page itself, with the picture it belongs to. */
const DIFFERENT_PEOPLE = "different-people";

export interface Quality {
  readonly text: string;
  readonly isBad: boolean;
}

type Judged = Pick<ScanResult, "verdict" | "agreement"> & {
  readonly warnings: readonly { readonly code: string }[];
  readonly views: readonly { readonly findings: readonly Pick<Finding, "severity">[] }[];
};

export function qualityOf(result: Judged): Quality {
  const findings = result.views.flatMap(({ findings }) => findings);
  const blocked = findings.some(({ severity }) => severity === "blocks");
  if (isContradicted(result)) return { text: "A picture does not show a person as it should: take it again.", isBad: true };
  if (result.warnings.some(({ code }) => code === DIFFERENT_PEOPLE)) {
    return { text: "The pictures contradict each other: do not trust these measurements.", isBad: true };
  }
  if (blocked) return { text: "Poor: take the picture again that is told of below.", isBad: true };
  if (findings.length > 0) return { text: "Fair: the pictures agree, but could be better. See below.", isBad: false };
  return { text: "Good: nothing is wrong with the pictures, and they agree.", isBad: false };
}
