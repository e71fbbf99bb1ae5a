// What the page says, and how it writes figures.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync } from "node:fs";
import { decimal, degrees, listed, measured, moment, percent, plural, typed } from "../../../service/page/src/messages/figures";
import { messages } from "../../../service/page/src/messages";
import { measureLabel } from "../../../service/page/src/result/reading";
import { answered, fieldName } from "../../../service/page/src/ui/answered";

/** Every message with its way through the catalogue. */
function* leaves(words: object, way = ""): Generator<[string, unknown]> {
  for (const [name, word] of Object.entries(words)) {
    if (typeof word === "object" && word !== null) yield* leaves(word, `${way}${name}.`);
    else yield [way + name, word];
  }
}

test("words that only the paper and the code know are in no message", () => {
  for (const [way, word] of leaves(messages)) {
    const said = typeof word === "string" ? word : String(word);
    assert.doesNotMatch(said, /\bnats\b|\bEq\. ?\d|\bSES?\b|limb_facing|\w_girth|Fig\. ?\d/, way);
  }
});

test("numbers, units and lists are written as English writes them", () => {
  assert.equal(decimal(1234.56, 1), "1,234.6");
  assert.equal(typed(1804.25, 1), "1804.3");
  assert.equal(percent(0.125, 1), "12.5%");
  assert.equal(measured(180.4, "centimeter", 1), "180.4 cm");
  assert.equal(degrees(30), "30°");
  assert.match(moment("2026-03-02T12:00:00Z"), /2026/);
  assert.equal(listed(["a", "b", "c"]), "a, b, and c");
  assert.equal(plural(1, { one: "one", other: "many" }), "one");
  assert.equal(plural(0, { one: "one", other: "many" }), "many");
});

test("every measurement has a label of its own", () => {
  const file = JSON.parse(readFileSync("../../fitter/measurement/definitions.json", "utf8"));
  const labels = file.measurements.map(({ name }: { name: string }) => measureLabel(name));
  assert.equal(new Set(labels).size, labels.length);
  assert.deepEqual(Object.keys(messages.measures.labels), file.measurements.map(({ name }: { name: string }) => name));
});

test("a known code is said in the page's words, an unknown one is left to the service", () => {
  assert.match(answered("faults", "image-damaged")!, /Choose another one/);
  assert.equal(answered("faults", "two-heights"), null);
  assert.equal(answered("faults", "toString"), null);
  assert.equal(fieldName("measurements.hip_girth.value"), "Hip");
  assert.equal(fieldName("points.left_hip"), "Left hip");
  assert.equal(fieldName("views.1.points.left_hip"), "Picture 2, Left hip");
  assert.equal(fieldName("body.some_field"), "body.some field");
});

