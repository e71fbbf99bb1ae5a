import assert from "node:assert/strict";
import { test } from "node:test";
import { gradeOf, qualityOf } from "../../../service/page/src/result/grade";
import type { Judged } from "../../../service/page/src/result/grade";

type View = Judged["views"][number];
const FOUND: View = { outcome: "converged", verdict: "plausible", silhouette_overlap: 0.953, warnings: [], findings: [] };
const ofOne = (view: View): Judged => ({ verdict: view.verdict, agreement: null, warnings: [], views: [view] });
const SEVERAL: Judged = { verdict: "plausible", agreement: 0.84, warnings: [], views: [FOUND, FOUND] };
const ofSeveral = (second: Partial<View>): Judged => ({ ...SEVERAL, views: [FOUND, { ...FOUND, ...second }] });

test("a fit is good where body and outline agree, and says by how much", () => {
  assert.equal(gradeOf(FOUND), "good");
  assert.deepEqual(qualityOf(ofOne(FOUND)), { grade: "good", text: "Good: body and outline overlap by 95%.", agreement: null });
});

test("an overlap that careless points reach too is fair", () => {
  const found = { ...FOUND, silhouette_overlap: 0.88 };
  assert.equal(gradeOf(found), "fair");
  assert.match(qualityOf(ofOne(found)).text, /^Fair: .* 88%; good fits reach more than 90%\.$/);
});

test("a doubtful outline, and a search that was stopped, are fair however well the body covers it", () => {
  for (const doubt of [{ warnings: [{ code: "segmentation-doubtful" }] }, { outcome: "evaluation_limit" } as const]) {
    assert.equal(gradeOf({ ...FOUND, ...doubt }), "fair");
    assert.match(qualityOf(ofOne({ ...FOUND, ...doubt })).text, /read the notes/);
  }
  assert.equal(gradeOf({ ...FOUND, warnings: [{ code: "ambiguous-limb-facing" }] }), "good");
});

test("what the picture contradicts is poor, whatever the overlap", () => {
  assert.equal(gradeOf({ ...FOUND, verdict: "no_person" }), "poor");
  assert.equal(gradeOf({ ...FOUND, outcome: "poor_fit", silhouette_overlap: 0.8 }), "poor");
});

test("a body that covers the person, in a picture that contradicts it, is not blamed on its overlap", () => {
  const { grade, text } = qualityOf(ofOne({ ...FOUND, verdict: "implausible" }));
  assert.equal(grade, "poor");
  assert.doesNotMatch(text, /overlap|%/);
  assert.match(qualityOf(ofOne({ ...FOUND, verdict: "implausible", silhouette_overlap: 0.7 })).text, /only 70%/);
});

test("several pictures agree only where the result says so", () => {
  const { grade, text, agreement } = qualityOf(SEVERAL);
  assert.equal(grade, "good");
  assert.match(text, /^Good.*they agree/);
  assert.match(agreement!, /84% of such pairs/);
  assert.match(qualityOf({ ...SEVERAL, agreement: 1 }).agreement!, /agree very well/);
  const others = qualityOf({ ...SEVERAL, agreement: 0.003, warnings: [{ code: "different-people" }] });
  assert.equal(others.grade, "poor");
  assert.match(others.text, /contradict/);
  assert.match(others.agreement!, /only 0\.3% of cases/);
});

test("findings say how good several pictures are, and nothing of agreement", () => {
  const fair = qualityOf(ofSeveral({ findings: [{ severity: "harms" }] }));
  assert.match(fair.text, /^Fair/);
  assert.doesNotMatch(fair.text, /agree/);
  assert.match(qualityOf(ofSeveral({ findings: [{ severity: "blocks" }] })).text, /^Poor/);
  const nobody = qualityOf({ ...SEVERAL, verdict: "no_person" });
  assert.equal(nobody.grade, "poor");
  assert.equal(nobody.agreement, null);
});

test("several pictures are no better than the one that the body does not fit", () => {
  assert.match(qualityOf(ofSeveral({ outcome: "poor_fit" })).text, /^Poor/);
});
