import assert from "node:assert/strict";
import { test } from "node:test";
import type { FitResult, Remark, ViewResult } from "../../../service/page/src/api/types";
import { NOBODY } from "../../../service/page/src/draft/person";
import { person } from "../../../service/page/src/draft/draft";
import { contradictionOf, gradeOf, headingOf } from "../../../service/page/src/result/quality";
import { notesOf } from "../../../service/page/src/result/remarks";

const IMAGE_CAMERA = { focal_length_px: 1000, width: 720, height: 960 };
const VIEW = { view: null, outcome: "converged", findings: [], warnings: [], assumptions: [], limb_facing: [], image_camera: IMAGE_CAMERA } as unknown as ViewResult;
const of = (view: Partial<ViewResult>, rest: Partial<FitResult> = {}) =>
  ({ verdict: "plausible", warnings: [], assumptions: [], height_m: 1.7, outcome_explanation: "", views: [VIEW, { ...VIEW, ...view }], ...rest }) as FitResult;
const remark = (code: string, severity: Remark["severity"] = "warns"): Remark => ({ code, severity, reason: `${code}.`, remedy: "", where: [] });

test("the grade follows the verdict, the outcomes and what there is to look at", () => {
  assert.equal(gradeOf(of({})), "good");
  for (const view of [{ outcome: "evaluation_limit" as const }, { findings: [remark("blurred")] }, { warnings: [remark("blurred")] }]) assert.equal(gradeOf(of(view)), "fair");
  for (const rest of [{ warnings: [remark("blurred")] }, { assumptions: [remark("height-assumed", "assumed")] }]) assert.equal(gradeOf(of({}, rest)), "fair");
  assert.equal(gradeOf(of({ outcome: "poor_fit" })), "poor");
  assert.equal(gradeOf(of({}, { verdict: "no_person" })), "poor");
});

test("a verdict against a person is the heading, whatever the outcome", () => {
  const found = { verdict: "no_person" as const };
  assert.equal(headingOf(of({ outcome: "poor_fit", assumptions: [remark("points-proposed", "assumed")] }, found)), "No person found");
  // Who placed the points knows that there is a person.
  assert.equal(headingOf(of({ outcome: "poor_fit" }, found)), "The body does not match the points");
  assert.equal(headingOf(of({ outcome: "poor_fit" })), "A poor match");
  assert.equal(headingOf(of({})), "The body");
});

test("only a verdict contradicts a body", () => {
  assert.equal(contradictionOf(of({})), null);
  assert.match(contradictionOf(of({}, { verdict: "implausible" }))!, /cannot be measured/);
});

test("what helps most is told first, what nobody can mend last, and nothing twice", () => {
  const lens = remark("lens-assumed", "assumed");
  const view = { findings: [remark("blurred", "harms"), remark("clothes-loose", "harms")], assumptions: [lens], warnings: [remark("clothes-loose")] };
  const result = of({ ...view, outcome: "poor_fit" }, { views: [{ ...VIEW, assumptions: [lens] }, { ...VIEW, ...view }], assumptions: [remark("height-assumed", "assumed")] });
  assert.deepEqual(notesOf(result).map(({ code, deed }) => [code, deed]), [
    ["height-assumed", "adjust"], ["clothes-loose", "adjust"], ["blurred", "another"], ["lens-assumed", null],
  ]);
  assert.equal(notesOf(of({ outcome: "poor_fit" }, { verdict: "implausible" }))[0]!.code, "implausible");
});

test("what is withheld is named as it is labelled, what most people ask for alone", () => {
  const withheld = { ...remark("measurements-withheld"), where: ["weight", "waist_girth_smallest", "elbow_girth"] };
  const [note] = notesOf(of({}, { warnings: [withheld] }));
  assert.match(note!.text, /^Left out: Weight and Waist, smallest, as /);
  assert.equal(note!.deed, "adjust");
});

test("loose clothes are told of in the units of the page", () => {
  const result = of({ findings: [{ ...remark("clothes-loose", "harms"), reason: "A top stands about 5 cm off.", remedy: "It is known to ± 7.6 cm." }] });
  const told = (units: "metric" | "imperial") => {
    person.value = { ...NOBODY, units };
    return notesOf(result)[0]!.text;
  };
  assert.equal(told("imperial"), "A top stands about 2.0 in off. It is known to ± 3.0 in.");
  assert.equal(told("metric"), "A top stands about 5 cm off. It is known to ± 7.6 cm.");
});
