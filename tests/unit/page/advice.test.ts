import assert from "node:assert/strict";
import { test } from "node:test";
import { adviceOf } from "../../../service/page/src/result/advice";

type Advised = Parameters<typeof adviceOf>[0];

const VIEW: Advised["views"][number] = {
  verdict: "plausible",
  agreement: null,
  outcome: "converged",
  silhouette_overlap: 0.86,
  findings: [],
  warnings: [],
  views: [],
  limb_facing: [],
  assumptions: [],
} as unknown as Advised["views"][number];

const advised = (view: object, weightGiven = false): Advised => ({
  verdict: "plausible",
  agreement: null,
  warnings: [],
  views: [{ ...VIEW, ...view }],
  measurements: [{ name: "weight", given: weightGiven }],
});

test("a good fit and one of several pictures are given no advice", () => {
  assert.equal(adviceOf(advised({ silhouette_overlap: 0.97 })), null);
  const { views, ...rest } = advised({});
  assert.equal(adviceOf({ ...rest, views: [...views, ...views] }), null);
});

test("what is surely wrong comes before what would only help", () => {
  const open = { limb_facing: [{ ambiguous: true }] };
  const swapped = { warnings: [{ code: "segmentation-doubtful" }, { code: "left-and-right-may-be-swapped" }] };
  assert.equal(adviceOf(advised({ ...open, ...swapped })), "sides");
  assert.equal(adviceOf(advised({ ...open, warnings: [{ code: "segmentation-doubtful" }] })), "mask");
  assert.equal(adviceOf(advised({ ...open, outcome: "poor_fit" })), "points");
  assert.equal(adviceOf(advised(open)), "limbs");
  assert.equal(adviceOf(advised({})), "weight");
  assert.equal(adviceOf(advised({}, true)), "points");
});

test("nobody is told to swap points that nobody clicked", () => {
  const swapped = { warnings: [{ code: "left-and-right-may-be-swapped" }] };
  const proposed = (value: string) => ({ ...swapped, assumptions: [{ quantity: "points", value, reason: "" }] });
  assert.equal(adviceOf(advised(proposed("left_eye, left_shoulder, right_shoulder, left_hip, right_hip"))), "points");
  assert.equal(adviceOf(advised(proposed("left_eye, left_shoulder, right_shoulder, left_hip"))), "sides");
});
