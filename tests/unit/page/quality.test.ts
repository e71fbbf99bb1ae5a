import assert from "node:assert/strict";
import { test } from "node:test";
import { contradictionOf, gradeOf, headingOf } from "../../../service/page/src/result/quality";

type Result = Parameters<typeof gradeOf>[0];
const VIEW: Result["views"][number] = { outcome: "converged", findings: [], warnings: [] };
const of = (view: Partial<typeof VIEW>, rest: Partial<Result> = {}): Result => ({ verdict: "plausible", warnings: [], views: [VIEW, { ...VIEW, ...view }], ...rest });

test("the grade follows the verdict, the outcomes and what there is to look at", () => {
  assert.equal(gradeOf(of({})), "good");
  for (const view of [{ outcome: "evaluation_limit" as const }, { findings: [{}] }, { warnings: [{}] }]) assert.equal(gradeOf(of(view)), "fair");
  assert.equal(gradeOf(of({}, { warnings: [{}] })), "fair");
  assert.equal(gradeOf(of({ outcome: "poor_fit" })), "poor");
  assert.equal(gradeOf(of({}, { verdict: "no_person" })), "poor");
});

test("a verdict against a person is the heading, whatever the outcome", () => {
  assert.equal(headingOf(of({ outcome: "poor_fit" }, { verdict: "no_person" })), "No person found");
  assert.equal(headingOf(of({ outcome: "poor_fit" })), "A poor match");
  assert.equal(headingOf(of({})), "The body");
});

test("only a verdict contradicts a body", () => {
  assert.equal(contradictionOf({ verdict: "plausible", outcome_explanation: "It converged." }), null);
  assert.match(contradictionOf({ verdict: "implausible", outcome_explanation: "" })!, /cannot be measured/);
});
