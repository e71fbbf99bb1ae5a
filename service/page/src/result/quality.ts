// How far a fit is to be trusted, as the service judges it.
import type { FitResult, ViewResult } from "../api/types";
import { wordFor } from "../messages/words";
import { messages } from "../messages";
import { answered } from "../ui/answered";

export type Grade = "good" | "fair" | "poor";

/** Poor by verdict or outcome, fair where a warning or a finding asks to look or the height is a guess, else good. */
export function gradeOf({ verdict, assumptions, warnings, views }: Judged): Grade {
  if (verdict !== "plausible" || views.some(({ outcome }) => outcome === "poor_fit")) return "poor";
  const isDoubted = views.some((view) => view.outcome !== "converged" || view.findings.length + view.warnings.length > 0);
  const isGuessed = assumptions.some(({ code }) => code === "height-assumed");
  return isDoubted || isGuessed || warnings.length > 0 ? "fair" : "good";
}

type JudgedView = Pick<ViewResult, "outcome"> & { readonly findings: readonly unknown[]; readonly warnings: readonly unknown[] };
type Judged = Pick<FitResult, "verdict" | "assumptions"> & { readonly warnings: readonly unknown[]; readonly views: readonly JudgedView[] };

/** Whether measurements of this body are to be shown as such. */
export function isReliable(result: Judged): boolean {
  return gradeOf(result) !== "poor";
}

/** Whether somebody placed all the points: then no person was looked for, and none can be missing. */
function isByHand(views: readonly Pick<ViewResult, "assumptions">[]): boolean {
  return views.every(({ assumptions }) => assumptions.every(({ code }) => code !== "points-proposed"));
}

type Headed = Pick<FitResult, "verdict"> & { readonly views: readonly Pick<ViewResult, "outcome" | "assumptions">[] };

export function headingOf({ verdict, views }: Headed): string {
  const { result: words } = messages;
  if (verdict === "no_person" && isByHand(views)) return words.mismatch;
  const isPoor = views.some(({ outcome }) => outcome === "poor_fit");
  return wordFor(words.verdicts, verdict) ?? (isPoor ? words.poorFit : words.body);
}

/** What contradicts the body, and what to do; null where nothing does. */
export function contradictionOf({ verdict, views, outcome_explanation: explained }: Headed & Pick<FitResult, "outcome_explanation">): string | null {
  if (verdict === "plausible") return null;
  return answered("verdicts", verdict === "no_person" && isByHand(views) ? "mismatch" : verdict) ?? explained;
}
