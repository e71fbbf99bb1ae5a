// The catalogues say the same things in every language, and figures are written as each writes them.
import assert from "node:assert/strict";
import { afterEach, test } from "node:test";
import { readFileSync } from "node:fs";
import { decimal, degrees, listed, measured, moment, percent, plural, typed } from "../../../service/page/src/messages/figures";
import { preferred, speak } from "../../../service/page/src/messages/language";
import { de } from "../../../service/page/src/messages/de";
import { en } from "../../../service/page/src/messages/en";
import { NOBODY, heightFault, heightTexts } from "../../../service/page/src/draft/person";
import { measureLabel } from "../../../service/page/src/result/reading";
import { answered, fieldName } from "../../../service/page/src/ui/answered";

const speakEnglish = () => speak({ language: "en", locale: "en", messages: en });
const speakGerman = (locale = "de") => speak({ language: "de", locale, messages: de });
afterEach(speakEnglish);

/** Every message with its way through the catalogue. */
function* leaves(words: object, way = ""): Generator<[string, unknown]> {
  for (const [name, word] of Object.entries(words)) {
    if (typeof word === "object" && word !== null) yield* leaves(word, `${way}${name}.`);
    else yield [way + name, word];
  }
}

test("both languages have the same messages with as many parameters", () => {
  const shape = (words: object) =>
    [...leaves(words)].filter(([way]) => !way.startsWith("answers.")).map(([way, word]) => [way, typeof word, typeof word === "function" ? word.length : 0]);
  assert.deepEqual(shape(de), shape(en));
});

test("German leaves nothing to the service's English", () => {
  for (const [way, word] of leaves(de.answers)) assert.equal(typeof word, "string", way);
});

test("words that only the paper and the code know are in no message", () => {
  for (const words of [en, de]) {
    for (const [way, word] of leaves(words)) {
      const said = typeof word === "string" ? word : String(word);
      assert.doesNotMatch(said, /\bnats\b|\bEq\. ?\d|\bSES?\b|limb_facing|\w_girth|Fig\. ?\d/, way);
    }
  }
});

test("the first language is taken that the page speaks, and English if it speaks none", () => {
  assert.equal(preferred(["fr-FR", "de-AT", "en"]), "de");
  assert.equal(preferred(["EN-gb", "de"]), "en");
  assert.equal(preferred(["fr", "den"]), "en");
  assert.equal(preferred([]), "en");
});

test("numbers are written with the comma or the point of the language, and of its region", () => {
  assert.equal(decimal(1234.56, 1), "1,234.6");
  speakGerman();
  assert.equal(decimal(1234.56, 1), "1.234,6");
  assert.equal(typed(1804.25, 1), "1804,3");
  assert.equal(percent(0.125, 1).replace(/\s/u, " "), "12,5 %");
  assert.equal(measured(180.4, "centimeter", 1).replace(/\s/u, " "), "180,4 cm");
  assert.equal(degrees(30), "30°");
  assert.match(moment("2026-03-02T12:00:00Z"), /^0?2\.0?3\.2026/);
  assert.equal(listed(["a", "b", "c"]), "a, b und c");
  assert.equal(plural(1, { one: "eins", other: "viele" }), "eins");
  assert.equal(plural(0, { one: "eins", other: "viele" }), "viele");
  speakGerman("de-CH");
  assert.equal(decimal(0.5, 1), "0.5");
});

test("what is shown in fields to type in is written as the language writes it, and read back", () => {
  speakGerman();
  const { height } = heightTexts(1.804, "metric");
  assert.equal(height, "180,4");
  assert.equal(heightFault({ ...NOBODY, height }), null);
});

test("every measurement has a label of its own in German", () => {
  speakGerman();
  const file = JSON.parse(readFileSync("../../fitter/measurement/definitions.json", "utf8"));
  const labels = file.measurements.map(({ name }: { name: string }) => measureLabel(name));
  assert.equal(new Set(labels).size, labels.length);
  assert.deepEqual(Object.keys(de.measures.labels), file.measurements.map(({ name }: { name: string }) => name));
});

test("a known code is said in the language spoken, an unknown one is left to the service", () => {
  assert.equal(answered("faults", "two-heights"), null);
  speakGerman();
  assert.match(answered("faults", "two-heights")!, /Körperhöhe/);
  assert.equal(answered("faults", "gone-fishing"), null);
  assert.equal(answered("faults", "toString"), null);
  assert.equal(fieldName("measurements.hip_girth.value"), "Hüftumfang");
  assert.equal(fieldName("points.left_hip"), "Linke Hüfte");
  assert.equal(fieldName("body.some_field"), "body.some field");
});

test("of a size chart the page says itself what is odd, without names of fields", () => {
  for (const code of ["chart-gap", "chart-overlap"]) assert.match(answered("warnings", code) ?? "", /sizes of the chart/);
});

test("every file of the recorded examples says what it is", () => {
  const names = new Set<string>();
  JSON.parse(readFileSync("../../api_schemas/openapi.json", "utf8"), (key, value) => {
    if (key === "artifacts" && Array.isArray(value)) for (const { name } of value) names.add(name.replace(/_\d+\./, "_N."));
    return value;
  });
  assert.ok(names.has("texture.jpg"));
  assert.deepEqual([...names].filter((name) => !Object.hasOwn(en.files.labels, name)), []);
});
