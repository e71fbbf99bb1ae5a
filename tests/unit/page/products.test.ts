import assert from "node:assert/strict";
import { test } from "node:test";
import { FIRST_WISHES, KINDS } from "../../../service/page/src/products/kinds";

test("a request says only what its kind knows", () => {
  const wishes = { ...FIRST_WISHES, size: 512 as const };
  assert.deepEqual(KINDS.texture.request(wishes), { kind: "texture", colours: "picture", size: 512 });
  assert.deepEqual(KINDS.animation.request({ ...wishes, named: "t_pose" }), { kind: "animation", motion: "t_pose" });
  assert.deepEqual(KINDS.animation.request({ ...wishes, motion: new File([], "dance.bvh") }), { kind: "animation" });
});

test("a size needs a chart", () => {
  assert.match(KINDS.size.lacks!(FIRST_WISHES)!, /chart/);
  const wishes = { ...FIRST_WISHES, chart: "size,hip_girth\nS,90-94\n" };
  assert.equal(KINDS.size.lacks!(wishes), null);
  assert.deepEqual(KINDS.size.request(wishes), { kind: "size", chart_csv: wishes.chart });
});
