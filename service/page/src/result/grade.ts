// How far a fit is to be trusted, in a few sentences.
import type { FittedView, Result } from "../api/fits";
import type { Finding } from "../api/types";
import { percent } from "../messages/figures";
import { messages } from "../messages";
import { isContradicted } from "./outcome";

export type Grade = "good" | "fair" | "poor";

/** Fits with points that are off, or of people half hidden, reach 0.90; with the sample's and most others it is more. */
const GOOD_OVERLAP = 0.9;

/** Below it the service warns, and a share is said to be small. */
const USUAL_AGREEMENT = 0.1;

/** Told by the page itself, with the picture it belongs to. */
const DIFFERENT_PEOPLE = "different-people";

/** Warnings of what was taken for the person's outline, which is what girths go by. */
const OUTLINE_DOUBTS: ReadonlySet<string> = new Set([
  "body-outside-picture",
  "clothes-not-loose",
  "cut-off",
  "left-and-right-may-be-swapped",
  "segmentation-doubtful",
  "several-people",
]);

interface Coded {
  readonly warnings: readonly { readonly code: string }[];
}
type JudgedView = Pick<FittedView, "outcome" | "verdict" | "silhouette_overlap"> & Coded & { readonly findings: readonly Pick<Finding, "severity">[] };
export type Judged = Pick<Result, "verdict" | "agreement"> & Coded & { readonly views: readonly JudgedView[] };

export interface Quality {
  readonly grade: Grade;
  readonly text: string;
  /** How well several pictures agree with each other; null where that says nothing. */
  readonly agreement: string | null;
}

export function qualityOf(result: Judged): Quality {
  const { agreement, views } = result;
  return agreement === null ? qualityOfView(views[0]!) : qualityOfSeveral(result, agreement);
}

/** Of the person in one picture. */
export function gradeOf(view: JudgedView): Grade {
  if (isContradicted(view) || view.outcome === "poor_fit") return "poor";
  const isDoubted = view.findings.length > 0 || view.warnings.some(({ code }) => OUTLINE_DOUBTS.has(code));
  return isDoubted || view.outcome !== "converged" || view.silhouette_overlap <= GOOD_OVERLAP ? "fair" : "good";
}

function qualityOfView(view: JudgedView): Quality {
  const { grades } = messages.result;
  const overlap = percent(view.silhouette_overlap);
  const grade = gradeOf(view);
  if (isContradicted(view) && view.silhouette_overlap > GOOD_OVERLAP) return { grade, text: grades.contradicted, agreement: null };
  if (grade !== "fair") return { grade, text: grades[grade](overlap), agreement: null };
  // Where the overlap is good, something else is in doubt, which a note tells.
  const text = view.silhouette_overlap <= GOOD_OVERLAP ? grades.fair(overlap, percent(GOOD_OVERLAP)) : grades.doubted(overlap);
  return { grade, text, agreement: null };
}

function qualityOfSeveral(result: Judged, share: number): Quality {
  const { quality } = messages.measure;
  const findings = result.views.flatMap(({ findings }) => findings);
  const agreement = agreementText(share);
  if (isContradicted(result)) return { grade: "poor", text: quality.contradicted, agreement: null };
  if (result.warnings.some(({ code }) => code === DIFFERENT_PEOPLE)) return { grade: "poor", text: quality.differentPeople, agreement };
  const isPoor = findings.some(({ severity }) => severity === "blocks") || result.views.some(({ outcome }) => outcome === "poor_fit");
  if (isPoor) return { grade: "poor", text: quality.poor, agreement };
  if (findings.length > 0) return { grade: "fair", text: quality.fair, agreement };
  return { grade: "good", text: quality.good, agreement };
}

function agreementText(share: number): string {
  const { quality } = messages.measure;
  if (share < USUAL_AGREEMENT) return quality.rarely(shareText(share));
  return share >= 0.995 ? quality.nearlyAlways : quality.often(shareText(share));
}

/** Small shares with a digit: one in a thousand is not none. */
function shareText(share: number): string {
  if (share < 0.0005) return messages.derived.lessThan(percent(0.001, 1));
  return percent(share, share < 0.0095 ? 1 : 0);
}
