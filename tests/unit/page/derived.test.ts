import assert from "node:assert/strict";
import { test } from "node:test";
import { FIRST_WISHES, KINDS, kindLabel, kindOf } from "../../../service/page/src/derived/kinds";
import { toldAlike } from "../../../service/page/src/derived/sameperson";

test("fits are of one person only with the same gender and height", () => {
  assert.ok(toldAlike({ gender: "male", height_m: 1.804 }, { gender: "male", height_m: 1.8040001 }));
  assert.ok(toldAlike({ gender: "female" }, { gender: "female", height_m: null }));
  assert.ok(!toldAlike({ gender: "male", height_m: 1.804 }, { gender: "female", height_m: 1.804 }));
  assert.ok(!toldAlike({ gender: "male", height_m: 1.804 }, { gender: "male", height_m: 1.806 }));
  assert.ok(!toldAlike({ gender: "male", height_m: 1.804 }, { gender: "male" }));
});

test("a request says only what its kind knows", () => {
  const wishes = { ...FIRST_WISHES, fits: ["one"], degrees: 45, size: 512 as const };
  assert.deepEqual(KINDS.texture.request(wishes), { kind: "texture", colours: "picture", size: 512 });
  assert.deepEqual(KINDS.figure.request(wishes), { kind: "figure", pose: "standing", degrees: 45 });
  assert.deepEqual(KINDS.combined.request(wishes), { kind: "combined", fits: ["one"] });
  assert.deepEqual(KINDS.animation.request({ ...wishes, named: "squat" }), { kind: "animation", motion: "squat" });
  assert.deepEqual(KINDS.animation.request({ ...wishes, motion: new File([], "dance.bvh") }), { kind: "animation" });
});

test("a texture of one's own is sent along, and needed", () => {
  const own = { ...FIRST_WISHES, colours: "own" as const };
  assert.match(KINDS.texture.lacks!(own)!, /Choose a texture/);
  assert.equal(KINDS.texture.part!({ ...FIRST_WISHES, texture: new File([], "skin.png") }), null);
  const chosen = { ...own, texture: new File([], "skin.png") };
  assert.equal(KINDS.texture.lacks!(chosen), null);
  assert.equal(KINDS.texture.part!(chosen)!.name, "texture");
  assert.deepEqual(KINDS.texture.request(chosen), { kind: "texture", colours: "own" });
});

test("nothing is combined before another fit is chosen", () => {
  assert.match(KINDS.combined.lacks!(FIRST_WISHES)!, /at least one/);
  assert.equal(KINDS.combined.lacks!({ ...FIRST_WISHES, fits: ["one"] }), null);
});

test("a kind this page does not know yet has a name all the same", () => {
  assert.equal(kindOf("hologram"), null);
  assert.equal(kindLabel("hologram"), "Hologram");
});

test("a typed size chart is sent as a table, without what was left empty", () => {
  assert.match(KINDS.size.lacks!(FIRST_WISHES)!, /chart/);
  const { columns } = FIRST_WISHES.chart;
  const sizes = [
    { label: "S, petite", cells: ["80-84", "", "88,5 – 92"] },
    { label: "M", cells: [" ", "", ""] },
    { label: "L", cells: ["88-92", "", ""] },
  ];
  const typed = { ...FIRST_WISHES, chart: { columns, sizes } };
  assert.equal(KINDS.size.lacks!(typed), null);
  assert.deepEqual(KINDS.size.request(typed), {
    kind: "size",
    chart_csv: 'size,chest_girth,hip_girth\n"S, petite",80-84,88.5 – 92\nL,88-92,\n',
  });
  assert.equal(KINDS.size.part!(typed), null);
});

test("a size chart in a file goes before what was typed", () => {
  const file = new File(["size,chest_girth\nM,94\n"], "shirts.csv");
  const chosen = { ...FIRST_WISHES, chartFile: file };
  assert.equal(KINDS.size.lacks!(chosen), null);
  assert.deepEqual(KINDS.size.request(chosen), { kind: "size" });
  assert.deepEqual(KINDS.size.part!(chosen), { name: "chart", file });
});
