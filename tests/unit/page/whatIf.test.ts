import assert from "node:assert/strict";
import { test } from "node:test";
import type { FitResult } from "../../../service/page/src/api/types";
import { bodyRequest } from "../../../service/page/src/result/whatIf";

const measured = (name: string, value: number) => ({ name, value, unit: "cm" });
const PERSON = {
  gender: "male",
  height_m: 1.8,
  measurements: [measured("weight", 74), measured("waist_girth_smallest", 77), measured("hip_girth", 93), measured("head_girth", 57)],
} as unknown as FitResult;

test("what is changed is asked for exactly, the build loosely, and nothing else", () => {
  assert.deepEqual(bodyRequest(PERSON, { weight: 5 }), {
    gender: "male",
    height_m: 1.8,
    measurements: { weight: 79, waist_girth_smallest: { value: 77, standard_error: 4 }, hip_girth: { value: 93, standard_error: 4 } },
  });
});

test("the body it is compared with differs in the change alone", () => {
  const change = { weight: -2, waist_girth_smallest: 3 };
  const [to, from] = [bodyRequest(PERSON, change), bodyRequest(PERSON, change, 0)];
  assert.deepEqual([to.measurements!.weight, from.measurements!.weight], [72, 74]);
  assert.deepEqual([to.measurements!.waist_girth_smallest, from.measurements!.waist_girth_smallest], [80, 77]);
  assert.deepEqual(to.measurements!.hip_girth, from.measurements!.hip_girth);
});
