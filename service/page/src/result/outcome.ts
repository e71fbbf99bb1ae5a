// How a fit ended, as a person reads it.
import type { FitResult } from "../api/types";

const CONTRADICTED: Readonly<Record<string, string>> = {
  implausible: "Not plausible",
  no_person: "No person found",
};

/** Whether the picture contradicts that a person was measured. */
export function isContradicted({ verdict }: Pick<FitResult, "verdict">): boolean {
  // Fits of earlier versions have no verdict.
  return (verdict ?? "plausible") !== "plausible";
}

export function headingOf(result: Pick<FitResult, "outcome" | "verdict">): string {
  return CONTRADICTED[result.verdict ?? ""] ?? (result.outcome === "poor_fit" ? "A poor fit" : "The body");
}
