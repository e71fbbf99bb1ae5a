import assert from "node:assert/strict";
import { test } from "node:test";
import { resultFor } from "../../../service/page/src/embed/result";
import { faultOfStart, faultOfTheme, faultOfToken } from "../../../service/page/src/embed/reading";

const start = (more: object) => faultOfStart({ type: "maquette:start", ...more });

test("all of a start may be left out or be null", () => {
  assert.equal(start({}), null);
  assert.equal(start({ token: null, lang: null, theme: null, subject: null, pictures: undefined }), null);
  assert.equal(start({ subject: { gender: null, height_m: undefined }, pictures: { front: null } }), null);
});

test("a whole start is taken", () => {
  const pictures = { front: new Blob(), side: new Blob() };
  const subject = { gender: "female", height_m: 1.555, weight_kg: 52 };
  assert.equal(start({ token: "mqt_1_a-b", lang: "de-AT", theme: "dark", subject, pictures, allow: ["save", "delete"] }), null);
});

const REFUSED: readonly (readonly [object, string])[] = [
  [{ tokens: "a" }, "tokens"],
  [{ token: 7 }, "token"],
  [{ token: "" }, "token"],
  [{ token: "a\nb" }, "token"],
  [{ lang: "fr" }, "lang"],
  [{ lang: 1 }, "lang"],
  [{ theme: "black" }, "theme"],
  [{ subject: "female" }, "subject"],
  [{ subject: [] }, "subject"],
  [{ subject: { gender: "f" } }, "subject.gender"],
  [{ subject: { height_m: 155.5 } }, "subject.height_m"],
  [{ subject: { height_m: "1.8" } }, "subject.height_m"],
  [{ subject: { height_m: Number.NaN } }, "subject.height_m"],
  [{ subject: { weight_kg: 0 } }, "subject.weight_kg"],
  [{ subject: { height_cm: 180 } }, "subject.height_cm"],
  [{ allow: "save" }, "allow"],
  [{ allow: ["print"] }, "allow"],
  [{ pictures: new Blob() }, "pictures"],
  [{ pictures: { front: "https://shop.example/front.jpg" } }, "pictures.front"],
  [{ pictures: { back: new Blob() } }, "pictures.back"],
];

for (const [more, field] of REFUSED) {
  test(`${JSON.stringify(more)} is refused at ${field}`, () => {
    const fault = start(more);
    assert.equal(fault?.field, field);
    assert.match(fault!.reason, /\.$/);
  });
}

test("a token is needed where a token is given", () => {
  assert.equal(faultOfToken(undefined)?.field, "token");
  assert.equal(faultOfToken("mqt_1_a"), null);
});

test("a theme is named", () => {
  assert.equal(faultOfTheme(undefined)?.field, "theme");
  for (const theme of ["light", "dark", "system"]) assert.equal(faultOfTheme(theme), null);
});

test("measurements come with the interval that holds 95 of 100, and with none where it is unknown", () => {
  const told = { name: "waist_girth_navel", unit: "cm", given: false, definition: "", source: "" };
  const found = { measurements: [{ ...told, value: 80, standard_error: 1, low: 78.04, high: 81.96 }, { ...told, value: 80, standard_error: null, low: null, high: null }], verdict: "plausible" as const, warnings: [] };
  const [sure, unsure] = resultFor("1", found).measurements;
  assert.deepEqual(sure, { name: told.name, unit: "cm", value: 80, low: 78.04, high: 81.96 });
  assert.deepEqual([unsure!.low, unsure!.high], [null, null]);
});
