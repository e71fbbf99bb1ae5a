// How a fit ended, as a person reads it.
import type { FitResult } from "../api/types";
import { wordFor } from "../messages/catalogue";
import { percent } from "../messages/figures";
import { messages } from "../messages/language";
import { answered } from "../ui/answered";

/** Whether the picture contradicts that a person was measured. */
export function isContradicted({ verdict }: Pick<FitResult, "verdict">): boolean {
  // Fits of earlier versions have no verdict.
  return (verdict ?? "plausible") !== "plausible";
}

export function headingOf(result: Pick<FitResult, "outcome" | "verdict">): string {
  const { result: words } = messages.value;
  return wordFor(words.verdicts, result.verdict ?? "") ?? (result.outcome === "poor_fit" ? words.poorFit : words.body);
}

/** What an outcome other than convergence means, and what to do; null where the service says it better. */
export function explanationOf(result: Pick<FitResult, "outcome" | "verdict" | "silhouette_overlap">): string | null {
  const { result: words } = messages.value;
  if (!isContradicted(result)) return wordFor(words.explained, result.outcome);
  const said = answered("verdicts", result.verdict!);
  return said && `${said} ${words.overlapIs(percent(result.silhouette_overlap))}`;
}
