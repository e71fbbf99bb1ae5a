import assert from "node:assert/strict";
import { test } from "node:test";
import { gradeInWords, gradeOf } from "../../../service/page/src/result/grade";

const FOUND = { outcome: "converged", verdict: "plausible", silhouette_overlap: 0.953, warnings: [] } as const;

test("a fit is good where body and outline agree, and says by how much", () => {
  assert.equal(gradeOf(FOUND), "good");
  assert.equal(gradeInWords(FOUND), "Good: body and outline overlap by 95%.");
});

test("an overlap that careless points reach too is fair", () => {
  const found = { ...FOUND, silhouette_overlap: 0.88 };
  assert.equal(gradeOf(found), "fair");
  assert.match(gradeInWords(found), /^Fair: .* 88%; good fits reach more than 90%\.$/);
});

test("a doubtful outline, and a search that was stopped, are fair however well the body covers it", () => {
  for (const doubt of [{ warnings: [{ code: "segmentation-doubtful" }] }, { outcome: "evaluation_limit" } as const]) {
    assert.equal(gradeOf({ ...FOUND, ...doubt }), "fair");
    assert.match(gradeInWords({ ...FOUND, ...doubt }), /see the notes below/);
  }
  assert.equal(gradeOf({ ...FOUND, warnings: [{ code: "ambiguous-limb-facing" }] }), "good");
});

test("what the picture contradicts is poor, whatever the overlap", () => {
  assert.equal(gradeOf({ ...FOUND, verdict: "no_person" }), "poor");
  assert.equal(gradeOf({ ...FOUND, outcome: "poor_fit", silhouette_overlap: 0.8 }), "poor");
});
