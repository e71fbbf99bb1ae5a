import assert from "node:assert/strict";
import { test } from "node:test";
import {
  NOBODY,
  heightFault,
  heightM,
  inUnits,
  personInWords,
  tapeFault,
  tapeMeasurements,
  tapeTexts,
  weightFault,
  weightKg,
} from "../../../service/page/src/draft/person";

const close = (value: number | null, expected: number) => assert.ok(Math.abs(value! - expected) < 1e-9, String(value));

test("nothing typed is unknown, not zero", () => {
  assert.equal(heightM(NOBODY), null);
  assert.equal(weightKg({ ...NOBODY, weight: "  " }), null);
  assert.equal(heightFault(NOBODY), null);
});

test("centimetres, decimal commas, feet with inches and pounds are understood", () => {
  close(heightM({ ...NOBODY, height: "180,4" }), 1.804);
  close(heightM({ ...NOBODY, units: "imperial", height: "5", inches: "11" }), 1.8034);
  close(weightKg({ ...NOBODY, units: "imperial", weight: "100" }), 45.359237);
});

test("nobody's height and words are told apart", () => {
  assert.match(heightFault({ ...NOBODY, height: "1.80" })!, /Between 120 and 230 cm/);
  assert.match(heightFault({ ...NOBODY, height: "tall" })!, /number/);
  assert.match(heightFault({ ...NOBODY, units: "imperial", height: "9" })!, /ft/);
  assert.notEqual(weightFault({ ...NOBODY, weight: "-3" }), null);
});

test("changing units keeps the person, to a millimetre and a tenth of a kilogram", () => {
  const metric = { ...NOBODY, height: "183.5", weight: "82.4" };
  const imperial = inUnits(metric, "imperial");
  assert.equal(imperial.height, "6");
  assert.ok(Math.abs(heightM(imperial)! - 1.835) < 0.001);
  assert.ok(Math.abs(weightKg(inUnits(imperial, "metric"))! - 82.4) < 0.06);
  assert.deepEqual(inUnits(metric, "metric"), metric);
});

test("there and back every height is the same tenth of a centimetre", () => {
  for (let mm = 1200; mm <= 2300; mm++) {
    const height = String(mm / 10);
    assert.equal(inUnits(inUnits({ ...NOBODY, height }, "imperial"), "metric").height, height);
  }
});

test("whole inches stay whole", () => {
  const imperial = { ...NOBODY, units: "imperial" as const, height: "5", inches: "11" };
  assert.deepEqual(inUnits(inUnits(imperial, "metric"), "imperial"), imperial);
});

test("feet and inches are understood as people write them", () => {
  const typed = (height: string, inches = "") => heightM({ ...NOBODY, units: "imperial", height, inches });
  const same: readonly (readonly [string, string?])[] = [
    ["5", "11.7"], ["5 ft 11.7 in"], ["5'11.7"], ["5’ 11,7”"], ["5'11.7\""], ["71.7"], ["", "71.7"], ["71.7 in"], ["5ft", "11.7"],
  ];
  for (const [height, inches] of same) close(typed(height, inches), 71.7 * 0.0254);
  close(typed("5'"), 60 * 0.0254);
  close(typed("5.5"), 66 * 0.0254);
  for (const [height, inches] of [["5'11", "3"], ["tall"], ["5'x"]] as const) assert.ok(Number.isNaN(typed(height, inches)), height);
});

test("what a tape says is trusted to a centimetre, in either unit, and survives the wire", () => {
  const taped = { ...NOBODY, tape: { hip_girth: "98,5", inseam: " " } };
  assert.deepEqual(tapeMeasurements(taped), { hip_girth: { value: 98.5, standard_error: 1 } });
  assert.deepEqual(tapeTexts(tapeMeasurements(taped), "metric"), { hip_girth: "98.5" });
  const inches = inUnits(taped, "imperial");
  assert.equal(inches.tape.hip_girth, "38.8");
  const back = tapeMeasurements(inches).hip_girth;
  close(typeof back === "object" ? back.value : null, 38.8 * 2.54);
  assert.deepEqual(tapeTexts({ hip_girth: 98 }, "metric"), { hip_girth: "98" });
});

test("a tape's value that nobody has, or that is no number, is a fault and is not sent as a number", () => {
  assert.equal(tapeFault({ ...NOBODY, tape: { chest_girth: "99" } }), null);
  assert.equal(tapeFault({ ...NOBODY, tape: { chest_girth: "0.99" } }), "chest_girth");
  const word = { ...NOBODY, tape: { calf_girth: "thick" } };
  assert.equal(tapeFault(word), "calf_girth");
  assert.deepEqual(tapeMeasurements(word), {});
});

test("a fit is told apart by whom it shows", () => {
  assert.equal(personInWords({ gender: "female", height_m: 1.65 }, "metric"), "Woman, 165 cm");
  assert.equal(personInWords({ gender: "male", height_m: 1.8034 }, "imperial"), "Man, 5 ft 11 in");
  assert.equal(personInWords({ gender: "male" }, "metric"), "Man");
});
