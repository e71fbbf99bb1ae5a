// How measurements are called, and what stands where.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { furtherMeasures, isChief, measureLabel } from "../../../service/page/src/result/reading";

const file = JSON.parse(readFileSync("../../fitter/measurement/definitions.json", "utf8"));
const measured: { name: string }[] = file.measurements;

test("every measurement stands once, among the chief ones or in a group", () => {
  const groups = furtherMeasures(measured);
  const further = groups.flatMap((group) => group.members.map((each) => each.name));
  const chief = measured.filter((each) => isChief(each.name)).map((each) => each.name);
  assert.deepEqual([...chief, ...further].sort(), measured.map((each) => each.name).sort());
  assert.equal(chief.length, 24);
  assert.deepEqual(
    groups.map((group) => group.heading),
    ["Girths", "Lengths", "Above the floor", "Breadths and depths"],
  );
});

test("no two measurements have one label", () => {
  const labels = measured.map((each) => measureLabel(each.name));
  assert.equal(new Set(labels).size, labels.length);
});

test("labels are words that begin with a capital", () => {
  assert.equal(measureLabel("stature"), "Height");
  assert.equal(measureLabel("neck_base_girth"), "Neck base");
  assert.equal(measureLabel("knee_height"), "Knee height");
  for (const { name } of measured) assert.match(measureLabel(name), /^[A-Z][^_]*$/);
});

test("results of earlier days have nothing further", () => {
  assert.deepEqual(furtherMeasures([{ name: "stature" }, { name: "hip_girth" }]), []);
});
