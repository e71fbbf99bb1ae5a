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

test("changing units keeps the person, to a quarter of an inch and a tenth of a kilogram", () => {
  const metric = { ...NOBODY, height: "183.5", weight: "82.4" };
  const imperial = inUnits(metric, "imperial");
  assert.equal(imperial.height, "6");
  assert.ok(Math.abs(heightM(imperial)! - 1.835) < 0.0032);
  assert.ok(Math.abs(weightKg(inUnits(imperial, "metric"))! - 82.4) < 0.06);
  assert.deepEqual(inUnits(metric, "metric"), metric);
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
