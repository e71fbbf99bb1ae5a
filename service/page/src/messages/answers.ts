// The codes of the service's answers that the page knows: what it says of them itself.
import type { measures } from "./en/measures";

/** Kinds of problems, by the last part of their `type`: headings. */
export const PROBLEM_TITLES = [
  "fit-crashed", "fit-expired", "fit-failed", "forbidden", "idempotency-key-reused", "insufficient-storage",
  "internal-error", "invalid-request", "malformed-request", "no-result", "not-ended", "not-found", "not-ready",
  "payload-too-large", "queue-full", "quota-exceeded", "request-timeout", "time-limit-exceeded",
  "too-many-connections", "too-many-requests", "unauthorized", "unsupported-media-type", "unusable-input",
  // The page's own.
  "page-error", "unexpected-answer", "unreachable",
] as const;

/** Problems and faults of fields, by `code`: what is wrong and what to do. */
export const FAULTS = [
  "bvh-skeleton-unknown", "bvh-too-far", "bvh-too-large", "bvh-too-long", "bvh-unreadable",
  "contradictory-measurements", "database-unavailable", "detector-not-installed", "disk-full", "draining",
  "empty-upload", "estimator-failed", "estimator-timeout", "estimator-unavailable", "fit-crashed", "fit-failed",
  "fits-unusable", "fit-expired", "focal-length-invalid", "image-animated", "image-damaged",
  "image-empty", "image-too-large", "image-too-narrow", "image-too-small", "image-unsupported",
  "input-gone", "internal-error", "mask-damaged", "mask-size", "mask-size-mismatch", "mask-without-background",
  "mask-without-foreground", "measurement-invalid", "no-light", "no-process", "no-worker", "not-a-bvh",
  "not-an-image", "not-found", "out-of-memory", "out-of-range", "person-not-found", "person-unknown",
  "point-outside-image", "points-too-close", "queue-full", "quota-exceeded", "rate-limit", "storage-full",
  "storage-unavailable", "submission-lost", "texture-size", "time-limit-exceeded", "too-few-points",
  "too-many-waiting", "two-heights", "unauthorized", "unknown-image", "wrong-role",
  // The page's own.
  "page-error", "unexpected-answer", "unreachable",
] as const;

/** Warnings of fits, scans, proposals, initial bodies and derivations, by `code`. */
export const WARNINGS = [
  "ambiguous-limb-facing", "body-outside-picture", "bvh-irregular", "chart-gap", "chart-overlap", "clip-cut", "clothes-not-loose", "cut-off", "different-people",
  "given-contradicted", "heights-differ", "implausible", "left-and-right-may-be-swapped", "limbs-crossed", "low-silhouette-overlap", "no-person",
  "nobody-found", "other-view", "person-too-small", "sandbox", "seen-from-behind", "segmentation-doubtful", "several-people",
  "shading-not-used", "shoulders-and-hips-disagree", "surroundings-not-found",
  "transparency-over-white", "unusual-height", "up-uncertain",
] as const;

/** Findings of checks of pictures, by `code`: what is wrong and what to do. */
export const FINDINGS = [
  "nobody-found", "several-people", "cut-off", "person-too-small", "picture-too-small", "other-view",
  "arms-against-trunk", "clothes-loose", "skin-not-found", "covered", "blurred", "too-dark", "too-bright", "camera-rolled", "camera-too-near",
  "not-standing", "child", "contradicted",
] as const;

/** Verdicts against a person: why, and what to do. */
export const VERDICTS = ["implausible", "no_person"] as const;

/** Assumptions whose figures the answer has in its prose alone, by quantity. */
export const ASSUMPTIONS = ["outline"] as const;

export type ProblemTitle = (typeof PROBLEM_TITLES)[number];
export type Fault = (typeof FAULTS)[number];
export type WarningCode = (typeof WARNINGS)[number];
export type FindingCode = (typeof FINDINGS)[number];
export type Verdict = (typeof VERDICTS)[number];
export type AssumedQuantity = (typeof ASSUMPTIONS)[number];

/** How every measurement is taken, as the service says with each. */
export type Definitions = Readonly<Record<keyof typeof measures.labels, string>>;

/** Null: the service's own English says it better, with its figures. */
export interface Answers {
  readonly titles: Readonly<Record<ProblemTitle, string | null>>;
  readonly faults: Readonly<Record<Fault, string | null>>;
  readonly warnings: Readonly<Record<WarningCode, string | null>>;
  readonly findings: Readonly<Record<FindingCode, string | null>>;
  readonly verdicts: Readonly<Record<Verdict, string | null>>;
  readonly assumptions: Readonly<Record<AssumedQuantity, string | null>>;
  readonly definitions: Definitions | null;
}

/** In a language that is not the service's everything has to be said. */
export interface TranslatedAnswers extends Answers {
  readonly titles: Readonly<Record<ProblemTitle, string>>;
  readonly faults: Readonly<Record<Fault, string>>;
  readonly warnings: Readonly<Record<WarningCode, string>>;
  readonly findings: Readonly<Record<FindingCode, string>>;
  readonly verdicts: Readonly<Record<Verdict, string>>;
  readonly assumptions: Readonly<Record<AssumedQuantity, string>>;
  readonly definitions: Definitions;
}
