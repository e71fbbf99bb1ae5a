// How far a fit is to be trusted, in a line.
import type { FitResult } from "../api/types";
import { percent } from "../messages/figures";
import { messages } from "../messages/language";
import { isContradicted } from "./outcome";

export type Grade = "good" | "fair" | "poor";

/** Fits with points that are off, or of people half hidden, reach 0.90; with the sample's and most others it is more. */
const GOOD_OVERLAP = 0.9;

/** Warnings of what was taken for the person's outline, which is what girths go by. */
const OUTLINE_DOUBTS: ReadonlySet<string> = new Set([
  "body-outside-picture",
  "clothes-not-loose",
  "cut-off",
  "left-and-right-may-be-swapped",
  "segmentation-doubtful",
  "several-people",
  "skin-not-found",
]);

type Judged = Pick<FitResult, "outcome" | "verdict" | "silhouette_overlap"> & {
  readonly warnings: readonly { readonly code: string }[];
};

export function gradeOf(result: Judged): Grade {
  if (isContradicted(result) || result.outcome === "poor_fit") return "poor";
  const isDoubted = result.warnings.some(({ code }) => OUTLINE_DOUBTS.has(code));
  return isDoubted || result.outcome !== "converged" || result.silhouette_overlap <= GOOD_OVERLAP ? "fair" : "good";
}

export function gradeInWords(result: Judged): string {
  const { grades } = messages.value.result;
  const overlap = percent(result.silhouette_overlap);
  const grade = gradeOf(result);
  if (grade !== "fair") return grades[grade](overlap);
  // Where the overlap is good, something else is in doubt, which a note tells.
  return result.silhouette_overlap <= GOOD_OVERLAP ? grades.fair(overlap, percent(GOOD_OVERLAP)) : grades.doubted(overlap);
}
